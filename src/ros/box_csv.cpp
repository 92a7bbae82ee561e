// SPDX-License-Identifier: BSD-3-Clause
#include "ros/box_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <locale>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

namespace box_query {
namespace {

constexpr std::array<const char*, 15> kColumns = {"scene", "stamp", "frame_id", "id", "class",
                                                  "cx",    "cy",    "cz",       "qx", "qy",
                                                  "qz",    "qw",    "sx",       "sy", "sz"};

struct Place {
  const std::string& name;
  std::size_t line = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name + ":" + std::to_string(line) + ": " + what);
  }
};

/// The fields of one line, without the quotes.
std::vector<std::string> split(const std::string& line, const Place& place) {
  std::vector<std::string> fields(1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ',') {
      fields.emplace_back();
    } else if (line[i] != '"') {
      fields.back() += line[i];
    } else {
      const std::string column = "field " + std::to_string(fields.size());
      if (!fields.back().empty()) {
        place.fail(column + ": a quote inside an unquoted field; quote the whole field");
      }
      for (++i; i < line.size() && (line[i] != '"' || line.compare(i, 2, "\"\"") == 0); ++i) {
        fields.back() += line[i];
        i += line[i] == '"' ? 1 : 0;
      }
      if (i == line.size()) {
        place.fail(column + ": the quote is not closed on this line");
      }
      if (i + 1 < line.size() && line[i + 1] != ',') {
        place.fail(column + ": text after the closing quote; a comma must follow");
      }
    }
  }
  return fields;
}

/// Field index of each of kColumns.
using Columns = std::array<std::size_t, kColumns.size()>;

Columns readHeader(const std::vector<std::string>& fields, const Place& place) {
  for (auto field = fields.begin(); field != fields.end(); ++field) {
    if (std::find(kColumns.begin(), kColumns.end(), *field) == kColumns.end()) {
      place.fail("unknown column '" + *field + "'");
    }
    if (std::find(fields.begin(), field, *field) != field) {
      place.fail("column " + *field + " is there twice");
    }
  }
  Columns columns;
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto field = std::find(fields.begin(), fields.end(), kColumns[i]);
    if (field == fields.end()) {
      place.fail(std::string("the header has no column ") + kColumns[i]);
    }
    columns[i] = static_cast<std::size_t>(field - fields.begin());
  }
  return columns;
}

/// Reads numbers by a stream of the classic locale rather than by std::from_chars, which GCC 9
/// lacks for double. To make one takes longer than to read a number.
class NumberReader {
 public:
  NumberReader() { in_.imbue(std::locale::classic()); }

  /// Whether the whole of the text is a finite number.
  bool read(const std::string& text, double& number) {
    in_.clear();
    in_.str(text);
    in_ >> std::noskipws >> number;
    return in_ && in_.peek() == std::istringstream::traits_type::eof() && std::isfinite(number);
  }

 private:
  std::istringstream in_;
};

/// One line of boxes, by column.
class Row {
 public:
  Row(const Columns& columns, std::vector<std::string> fields, NumberReader& numbers,
      const Place& place)
      : columns_(columns), fields_(std::move(fields)), numbers_(numbers), place_(place) {}

  const std::string& text(const char* column) const {
    const auto found = std::find_if(kColumns.begin(), kColumns.end(),
                                    [&](std::string_view name) { return name == column; });
    return fields_[columns_[static_cast<std::size_t>(found - kColumns.begin())]];
  }

  double number(const char* column) const {
    double value = 0.0;
    if (!numbers_.read(text(column), value)) {
      fail(column, "'" + text(column) + "' is not a finite number");
    }
    return value;
  }

  [[noreturn]] void fail(const char* column, const std::string& what) const {
    place_.fail(std::string("column ") + column + ": " + what);
  }

 private:
  const Columns& columns_;
  std::vector<std::string> fields_;
  NumberReader& numbers_;
  const Place& place_;
};

double readSize(const Row& row, const char* column) {
  const double size = row.number(column);
  if (size < 0.0) {
    row.fail(column, "a size must not be negative, but this is " + row.text(column));
  }
  return size;
}

CsvBox readBox(const Row& row, std::size_t line) {
  CsvBox box;
  box.frame_id = row.text("frame_id");
  if (box.frame_id.empty()) {
    row.fail("frame_id", "a box needs a frame");
  }
  box.id = row.text("id");
  box.box_class = row.text("class");
  box.center = Vector3(row.number("cx"), row.number("cy"), row.number("cz"));
  box.orientation =
      Quaternion(row.number("qw"), row.number("qx"), row.number("qy"), row.number("qz"));
  if ((box.orientation.coeffs().array() == 0.0).all()) {
    row.fail("qx", "the quaternion is zero; no rotation is 0,0,0,1");
  }
  box.size = Vector3(readSize(row, "sx"), readSize(row, "sy"), readSize(row, "sz"));
  box.line = line;
  return box;
}

/// The next line without its line end, or false.
bool readLine(std::istream& in, std::string& line) {
  if (!std::getline(in, line)) {
    return false;
  }
  if (!line.empty() && line.back() == '\r') {
    line.pop_back();
  }
  return true;
}

}  // namespace

std::vector<CsvScene> readBoxCsv(std::istream& in, const std::string& name) {
  Place place{name};
  std::string line;
  Columns columns{};
  NumberReader numbers;
  bool has_header = false;
  std::vector<CsvScene> scenes;
  std::map<std::pair<std::string, double>, std::size_t> scene_index;
  std::set<std::tuple<std::size_t, std::string, std::string>> seen;
  while (readLine(in, line)) {
    ++place.line;
    if (place.line == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0) {
      line.erase(0, 3);  // byte order mark of UTF-8
    }
    if (line.empty()) {
      continue;
    }
    std::vector<std::string> fields = split(line, place);
    if (!has_header) {
      columns = readHeader(fields, place);
      has_header = true;
      continue;
    }
    if (fields.size() != kColumns.size()) {
      place.fail(std::to_string(fields.size()) + " fields, but the header has " +
                 std::to_string(kColumns.size()));
    }
    const Row row(columns, std::move(fields), numbers, place);
    const std::pair<std::string, double> key(row.text("scene"), row.number("stamp"));
    const auto [scene, is_new] = scene_index.emplace(key, scenes.size());
    if (is_new) {
      scenes.push_back({key.first, key.second, {}});
    }
    CsvBox box = readBox(row, place.line);
    if (!seen.emplace(scene->second, box.box_class, box.id).second) {
      row.fail("id", "'" + box.id + "' of class '" + box.box_class + "' is there twice in scene '" +
                         key.first + "' at stamp " + row.text("stamp"));
    }
    scenes[scene->second].boxes.push_back(std::move(box));
  }
  if (in.bad()) {
    place.fail("the file cannot be read");
  }
  if (!has_header) {
    throw std::runtime_error(name + ": the file is empty; its first line names the columns");
  }
  return scenes;
}

std::vector<CsvScene> readBoxCsvFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw std::runtime_error(path + ": the file cannot be opened");
  }
  return readBoxCsv(in, path);
}

}  // namespace box_query
