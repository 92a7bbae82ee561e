// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where every field of a message stands on the wire, found out by its own serialiser, so that
/// tests can spoil each and forget none.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/array.hpp>
#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace box_query::test {

struct RecordedField {
  enum class Kind { kDouble, kFloat, kInteger, kTime, kString, kCount };

  Kind kind;
  std::size_t top;   ///< number of the message's own field that it is, or is within
  std::size_t at;    ///< of its first byte; of a string or an array that of its length
  std::size_t size;  ///< bytes; of a string those behind its length; of an array its elements
};

/// A stream for serialisers, that notes where fields are instead of writing them.
class FieldRecorder {
 public:
  template <typename T>
  void next(const T& field) {
    using Kind = RecordedField::Kind;
    if constexpr (std::is_floating_point_v<T>) {
      add(sizeof(T) == sizeof(double) ? Kind::kDouble : Kind::kFloat, sizeof(T));
    } else if constexpr (std::is_arithmetic_v<T>) {
      add(Kind::kInteger, sizeof(T));
    } else if constexpr (std::is_same_v<T, ros::Time> || std::is_same_v<T, ros::Duration>) {
      add(Kind::kTime, 2 * sizeof(std::uint32_t));
    } else {
      ++depth_;
      walk(field);
      --depth_;
    }
    top_ += depth_ == 0 ? 1 : 0;
  }

  const std::vector<RecordedField>& fields() const { return fields_; }

 private:
  void add(RecordedField::Kind kind, std::size_t size) {
    fields_.push_back({kind, top_, at_, size});
    at_ += size;
  }
  void walk(const std::string& text) {
    fields_.push_back({RecordedField::Kind::kString, top_, at_, text.size()});
    at_ += sizeof(std::uint32_t) + text.size();
  }
  template <typename T>
  void walk(const std::vector<T>& elements) {
    fields_.push_back({RecordedField::Kind::kCount, top_, at_, elements.size()});
    at_ += sizeof(std::uint32_t);
    for (const T& element : elements) {
      next(element);
    }
  }
  template <typename T, std::size_t N>
  void walk(const boost::array<T, N>& elements) {
    for (const T& element : elements) {
      next(element);
    }
  }
  template <typename Message>
  void walk(const Message& message) {
    ros::serialization::Serializer<Message>::write(*this, message);
  }

  std::vector<RecordedField> fields_;
  std::size_t at_ = 0;
  std::size_t top_ = 0;
  int depth_ = 0;
};

template <typename Message>
std::vector<RecordedField> fieldsOf(const Message& message) {
  FieldRecorder recorder;
  ros::serialization::Serializer<Message>::write(recorder, message);
  return recorder.fields();
}

/// Names of a message's own fields, by its definition.
template <typename Message>
std::vector<std::string> fieldNames() {
  std::istringstream definition(ros::message_traits::definition<Message>());
  std::vector<std::string> names;
  for (std::string line; std::getline(definition, line) && line.rfind("====", 0) != 0;) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type;
    std::string name;
    if (words >> type >> name && name.find('=') == std::string::npos) {
      names.push_back(name);
    }
  }
  return names;
}

/// The message with other bytes at a field of fixed size.
template <typename Value>
std::vector<std::uint8_t> withValue(std::vector<std::uint8_t> bytes, const RecordedField& field,
                                    const Value& value) {
  std::memcpy(&bytes.at(field.at), &value, sizeof(value));
  return bytes;
}

/// The message with another string in place of one.
inline std::vector<std::uint8_t> withString(const std::vector<std::uint8_t>& bytes,
                                            const RecordedField& field, const std::string& text) {
  const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(field.at);
  const auto end = begin + static_cast<std::ptrdiff_t>(sizeof(std::uint32_t) + field.size);
  std::vector<std::uint8_t> result(bytes.begin(), begin);
  result.resize(result.size() + sizeof(std::uint32_t));
  const auto length = static_cast<std::uint32_t>(text.size());
  std::memcpy(&result[field.at], &length, sizeof(length));
  result.insert(result.end(), text.begin(), text.end());
  result.insert(result.end(), end, bytes.end());
  return result;
}

inline const std::vector<double>& hostileDoubles() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNumber = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<double> values = {kNumber,  -kNumber, kInfinity, -kInfinity, 1.7e308,
                                             -1.7e308, 1e300,    -1e300,    1e100,      -1e9,
                                             1.1e7,    -1.0,     -0.0,      0.0,        5e-324,
                                             -5e-324,  1e-310,   2.3e-308,  1e-250,     -1e-100};
  return values;
}

/// Of any width, from the lowest bytes.
inline const std::vector<std::uint64_t>& hostileIntegers() {
  static const std::vector<std::uint64_t> values = {0,
                                                    1,
                                                    2,
                                                    3,
                                                    0x7f,
                                                    0x80,
                                                    0xff,
                                                    0x7fff,
                                                    0x7fffffff,
                                                    0x80000000,
                                                    ~std::uint64_t{0},
                                                    std::uint64_t{1} << 63U};
  return values;
}

inline const std::vector<std::string>& hostileStrings() {
  using std::string_literals::operator""s;
  static const std::vector<std::string> values = {"",
                                                  " ",
                                                  "a b",
                                                  "/",
                                                  "//",
                                                  "a/../b",
                                                  "\xff\xfe\xc0",
                                                  "a\0b"s,
                                                  "\0"s,
                                                  "'; \"<\n\033[31m%s%n",
                                                  std::string(255, 'x'),
                                                  std::string(256, 'x'),
                                                  std::string(1000000, 'x')};
  return values;
}

/// Wrong ones for a string or an array of that length.
inline std::vector<std::uint32_t> wrongLengths(std::size_t length) {
  const auto right = static_cast<std::uint32_t>(length);
  return {0, right + 1, right - 1, right + 1000, 65536, 0x7fffffff, 0x80000000, 0xffffffff};
}

}  // namespace box_query::test
