// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_csv.h"

#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using box_query::CsvScene;
using box_query::readBoxCsv;

const std::string kHeader = "scene,stamp,frame_id,id,class,cx,cy,cz,qx,qy,qz,qw,sx,sy,sz\n";
const std::string kBox = "a,0,map,shelf,rack,1,2,3,0,0,0,1,4,5,6\n";

std::vector<CsvScene> read(const std::string& text) {
  std::istringstream in(text);
  return readBoxCsv(in, "file.csv");
}

/// What the reader says of a text that it refuses.
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "(accepted)";
}

/// The text with the field of kBox that follows `n` commas replaced.
std::string withField(int n, const std::string& field) {
  std::size_t begin = 0;
  for (int i = 0; i < n; ++i) {
    begin = kBox.find(',', begin) + 1;
  }
  std::string line = kBox;
  return kHeader + line.replace(begin, kBox.find_first_of(",\n", begin) - begin, field);
}

TEST(BoxCsv, ReadsEveryColumn) {
  const auto scenes = read(kHeader + "a,1.5,map,shelf,rack,1,-2,3e-1,0.1,0.2,0.3,0.9,4,5,0\n");
  ASSERT_EQ(scenes.size(), 1U);
  EXPECT_EQ(scenes[0].scene, "a");
  EXPECT_EQ(scenes[0].stamp, 1.5);
  ASSERT_EQ(scenes[0].boxes.size(), 1U);
  const auto& box = scenes[0].boxes[0];
  EXPECT_EQ(box.frame_id, "map");
  EXPECT_EQ(box.id, "shelf");
  EXPECT_EQ(box.box_class, "rack");
  EXPECT_EQ(box.center, box_query::Vector3(1, -2, 3e-1));
  EXPECT_EQ(box.orientation.coeffs(), Eigen::Vector4d(0.1, 0.2, 0.3, 0.9));
  EXPECT_EQ(box.size, box_query::Vector3(4, 5, 0));
  EXPECT_EQ(box.line, 2U);
}

TEST(BoxCsv, HeaderGivesTheOrderOfTheColumns) {
  const auto scenes = read(
      "sz,sy,sx,qw,qz,qy,qx,cz,cy,cx,class,id,frame_id,stamp,scene\n"
      "6,5,4,1,0,0,0,3,2,1,rack,shelf,map,7,a\n");
  ASSERT_EQ(scenes.size(), 1U);
  EXPECT_EQ(scenes[0].stamp, 7);
  EXPECT_EQ(scenes[0].boxes[0].center, box_query::Vector3(1, 2, 3));
  EXPECT_EQ(scenes[0].boxes[0].size, box_query::Vector3(4, 5, 6));
}

TEST(BoxCsv, GroupsBySceneAndStampInOrderOfAppearance) {
  const std::string rest = ",map,x,c,0,0,0,0,0,0,1,1,1,1\n";
  const std::string other = ",map,y,c,0,0,0,0,0,0,1,1,1,1\n";
  const auto scenes = read(kHeader + "b,0" + rest + "a,2" + rest + "a,1" + rest + "b,0.0" + other);
  ASSERT_EQ(scenes.size(), 3U);
  EXPECT_EQ(scenes[0].scene, "b");
  EXPECT_EQ(scenes[0].boxes.size(), 2U);
  EXPECT_EQ(scenes[1].stamp, 2);
  EXPECT_EQ(scenes[2].stamp, 1);
}

TEST(BoxCsv, TakesQuotesCrlfBlankLinesAndByteOrderMark) {
  const std::string header(kHeader, 0, kHeader.size() - 1);
  const auto scenes = read("\xEF\xBB\xBF" + header +
                           "\r\n\r\n\"a, \"\"b\"\"\",\"0\",map,\"\",c,1,2,3,0,0,0,1,4,5,6\r\n\n" +
                           "a,0,map,last,c,1,2,3,0,0,0,1,4,5,6");
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_EQ(scenes[0].scene, "a, \"b\"");
  EXPECT_EQ(scenes[0].boxes[0].id, "");
  EXPECT_EQ(scenes[0].boxes[0].line, 3U);
  EXPECT_EQ(scenes[1].boxes[0].size.z(), 6);
}

TEST(BoxCsv, NumbersAreCorrectlyRounded) {
  for (const auto& [text, value] : std::vector<std::pair<std::string, double>>{
           {"0.1", 0.1},
           {"9007199254740993", 9007199254740992.0},  // halfway: to even
           {"4.9406564584124654e-324", 4.9406564584124654e-324},
           {"1.7976931348623157e308", 1.7976931348623157e308},
           {"-0.00000000000000000000001", -1e-23}}) {
    EXPECT_EQ(read(withField(5, text))[0].boxes[0].center.x(), value) << text;
  }
}

TEST(BoxCsv, DoesNotDependOnTheLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const auto scenes = read(withField(5, "1.125"));
  std::locale::global(before);
  EXPECT_EQ(scenes[0].boxes[0].center.x(), 1.125);
}

TEST(BoxCsv, RefusesWhatIsNoFiniteNumber) {
  for (const char* bad : {"", " 1", "1 ", "nan", "inf", "-inf", "1e400", "0x10", "1.0.0", "abc"}) {
    EXPECT_EQ(refusal(withField(6, bad)),
              "file.csv:2: column cy: '" + std::string(bad) + "' is not a finite number");
  }
  EXPECT_EQ(refusal(withField(1, "soon")),
            "file.csv:2: column stamp: 'soon' is not a finite number");
}

TEST(BoxCsv, RefusesWhatIsNoBox) {
  EXPECT_EQ(refusal(withField(13, "-0.5")),
            "file.csv:2: column sy: a size must not be negative, but this is -0.5");
  EXPECT_EQ(refusal(withField(11, "0")),
            "file.csv:2: column qx: the quaternion is zero; no rotation is 0,0,0,1");
  EXPECT_EQ(refusal(withField(2, "")), "file.csv:2: column frame_id: a box needs a frame");
  EXPECT_EQ(
      refusal(kHeader + kBox + "\n" + kBox),
      "file.csv:4: column id: 'shelf' of class 'rack' is there twice in scene 'a' at stamp 0");
}

TEST(BoxCsv, RefusesLinesThatAreNotWhole) {
  EXPECT_EQ(refusal(kHeader + "a,0,map\n"), "file.csv:2: 3 fields, but the header has 15");
  EXPECT_EQ(refusal(kHeader + "a,\"0,map\n"),
            "file.csv:2: field 2: the quote is not closed on this line");
  EXPECT_EQ(refusal(kHeader + "a,\"0\"1,map\n"),
            "file.csv:2: field 2: text after the closing quote; a comma must follow");
  EXPECT_EQ(refusal(kHeader + "a,0\"1\",map\n"),
            "file.csv:2: field 2: a quote inside an unquoted field; quote the whole field");
}

TEST(BoxCsv, RefusesAHeaderThatIsNotWhole) {
  EXPECT_EQ(refusal(""), "file.csv: the file is empty; its first line names the columns");
  EXPECT_EQ(refusal(kBox), "file.csv:1: unknown column 'a'");
  EXPECT_EQ(refusal("scene,stamp,scene\n"), "file.csv:1: column scene is there twice");
  EXPECT_EQ(refusal("scene,stamp,frame_id,id,class,cx,cy,cz,qx,qy,qz,qw,sx,sy\n"),
            "file.csv:1: the header has no column sz");
}

TEST(BoxCsv, AFileThatIsNotThereIsNamed) {
  try {
    box_query::readBoxCsvFile("/no such/file.csv");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/no such/file.csv: the file cannot be opened");
  }
}

}  // namespace
