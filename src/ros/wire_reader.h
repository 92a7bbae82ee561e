// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reading of ROS-serialised bytes that trusts none of them.
#pragma once

#include <box_query/geometry.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <ros/time.h>

namespace box_query {

/// std_msgs/Header without its sequence number.
struct WireHeader {
  ros::Time stamp;
  std::string_view frame;  ///< into the bytes, as it stands there
};

/// As wide as Eigen reads: numbers that were just written one by one would be waited for.
template <typename Numbers>
void copyNumbers(const std::uint8_t* bytes, Numbers&& numbers) {
  std::memcpy(numbers.data(), bytes, static_cast<std::size_t>(numbers.size()) * sizeof(double));
}

/// geometry_msgs/Pose and, right after it, a geometry_msgs/Vector3 of full sides [m].
struct WireBox {
  static constexpr std::size_t kSize = 10 * sizeof(double);
  /// Where they begin in its bytes.
  static constexpr std::size_t kOrientation = 3 * sizeof(double);
  static constexpr std::size_t kSides = 7 * sizeof(double);

  WireBox() : center(0.0, 0.0, 0.0), orientation(0.0, 0.0, 0.0, 0.0), size(0.0, 0.0, 0.0) {}
  explicit WireBox(const std::uint8_t* bytes) {
    copyNumbers(bytes, center);
    copyNumbers(bytes + kOrientation, orientation.coeffs());
    copyNumbers(bytes + kSides, size);
  }

  Vector3 center;
  Quaternion orientation;
  Vector3 size;
};

/// Fields of fixed sizes, one behind the other, that are known to fit: their reader has looked
/// once.
class WireBlock {
 public:
  explicit WireBlock(const std::uint8_t* bytes) : next_(bytes) {}

  template <typename T>
  T number() {
    T value = 0;
    std::memcpy(&value, next_, sizeof(T));
    next_ += sizeof(T);
    return value;
  }
  /// Straight into what is returned: a copy would be waited for.
  WireBox box() {
    next_ += WireBox::kSize;
    return WireBox(next_ - WireBox::kSize);
  }
  /// A duration in nanoseconds: any two 32-bit numbers fit.
  std::int64_t duration() {
    const std::int64_t seconds = number<std::int32_t>();
    return seconds * 1000000000 + number<std::int32_t>();
  }
  Vector3 vector() {
    Vector3 value;
    copyNumbers(next_, value);
    next_ += sizeof(value);
    return value;
  }
  Quaternion quaternion() {
    Quaternion value;
    copyNumbers(next_, value.coeffs());
    next_ += sizeof(value);
    return value;
  }
  void skip(std::size_t size) { next_ += size; }
  const std::uint8_t* bytes() const { return next_; }

 private:
  const std::uint8_t* next_;
};

/// An array, still in the bytes, of elements of one size: all of them fit.
struct WireArray {
  std::uint32_t count = 0;
  WireBlock elements{nullptr};
};

/// Reads the fields of a message in their order. Once something does not fit, ok() is false for
/// good and everything reads as zero or empty, so that a decoder need look only once, at its end.
/// Nothing is allocated here; views are into the bytes.
class WireReader {
 public:
  /// Names are strings that are kept, for every box that has them.
  WireReader(const std::uint8_t* data, std::size_t size,
             std::size_t max_name_length = std::numeric_limits<std::size_t>::max())
      : begin_(data), next_(data), left_(size), max_name_length_(max_name_length) {}

  bool ok() const { return failure_.empty(); }
  /// What did not fit; empty if ok().
  const std::string& failure() const { return failure_; }
  std::size_t left() const { return left_; }

  /// A number. The wire is little endian, as every machine that roscpp runs on.
  template <typename T>
  T number() {
    static_assert(std::is_arithmetic<T>::value, "numbers only");
    T value = 0;
    if (const std::uint8_t* bytes = take(sizeof(T))) {
      std::memcpy(&value, bytes, sizeof(T));
    }
    return value;
  }

  /// So many bytes of fields; zeros if they do not fit.
  template <std::size_t kSize>
  WireBlock block() {
    static constexpr std::uint8_t kZeros[kSize] = {};
    const std::uint8_t* const bytes = take(kSize);
    return WireBlock(bytes ? bytes : kZeros);
  }

  std::string_view string() {
    const auto size = number<std::uint32_t>();
    const std::uint8_t* bytes = take(size);
    return bytes ? std::string_view(reinterpret_cast<const char*>(bytes), size)
                 : std::string_view();
  }

  /// A string that must not be longer than names may be: `what` says what it is.
  std::string_view name(const char* what) {
    const std::string_view text = string();
    if (text.size() > max_name_length_) {
      failName(what, text.size());
      return {};
    }
    return text;
  }

  /// The length of an array whose elements take at least `element_size` bytes each: 0 and a failure
  /// if so many cannot follow. Memory that is reserved for the result is bounded by the message.
  std::uint32_t count(std::size_t element_size) {
    const auto elements = number<std::uint32_t>();
    if (elements > left_ / element_size) {
      fail("an array claims " + std::to_string(elements) + " elements");
      return 0;
    }
    return elements;
  }

  /// An array whose elements have `element_size` bytes each; empty if it does not fit.
  WireArray array(std::size_t element_size) {
    const std::uint32_t elements = count(element_size);
    return {elements, WireBlock(take(std::uint64_t{elements} * element_size))};
  }

  void skip(std::uint64_t size) { take(size); }

  ros::Time time() { return timeOf(block<kTime>()); }

  /// A duration in nanoseconds: any two 32-bit numbers fit.
  std::int64_t duration() { return block<2 * sizeof(std::int32_t)>().duration(); }

  WireHeader header() {
    WireBlock block = this->block<sizeof(std::uint32_t) + kTime>();
    block.skip(sizeof(std::uint32_t));  // seq
    const ros::Time stamp = timeOf(block);
    return {stamp, name("frame")};
  }

  Vector3 vector() {
    Vector3 value = Vector3::Zero();
    if (const std::uint8_t* bytes = take(kVector)) {
      copyNumbers(bytes, value);
    }
    return value;
  }

  WireBox box() {
    const std::uint8_t* bytes = take(WireBox::kSize);
    return bytes ? WireBox(bytes) : WireBox();
  }

  /// geometry_msgs/Quaternion: x, y, z, w, which is Eigen's own order.
  Quaternion quaternion() {
    Quaternion value(0.0, 0.0, 0.0, 0.0);
    if (const std::uint8_t* bytes = take(kQuaternion)) {
      copyNumbers(bytes, value.coeffs());
    }
    return value;
  }

 private:
  static constexpr std::size_t kVector = 3 * sizeof(double);
  static constexpr std::size_t kQuaternion = 4 * sizeof(double);
  static constexpr std::size_t kTime = 2 * sizeof(std::uint32_t);

  ros::Time timeOf(WireBlock block) {
    ros::Time value;
    value.sec = block.number<std::uint32_t>();
    value.nsec = block.number<std::uint32_t>();
    if (value.nsec >= 1000000000U) {  // what ros::Time's own functions throw at
      fail("a time has " + std::to_string(value.nsec) + " nanoseconds");
      return ros::Time();
    }
    return value;
  }

  const std::uint8_t* take(std::uint64_t size) {
    if (size > left_) {
      failField(size);
      return nullptr;
    }
    const std::uint8_t* bytes = next_;
    next_ += size;
    left_ -= static_cast<std::size_t>(size);
    return bytes;
  }

  /// Out of line, so that what reads can be inlined.
  [[gnu::noinline, gnu::cold]] void failField(std::uint64_t size) {
    fail("a field of " + std::to_string(size) + " bytes is expected");
  }

  [[gnu::noinline, gnu::cold]] void failName(const char* what, std::size_t size) {
    fail("a " + std::string(what) + " of " + std::to_string(size) + " bytes, at most " +
         std::to_string(max_name_length_) +
         " are taken (shorten it, or raise ~max_name_length), ends");
  }

  [[gnu::noinline, gnu::cold]] void fail(const std::string& what) {
    if (ok()) {
      failure_ = what + " at byte " + std::to_string(next_ - begin_) + ", where " +
                 std::to_string(left_) + " bytes remain";
    }
    next_ += left_;
    left_ = 0;
  }

  const std::uint8_t* begin_;
  const std::uint8_t* next_;
  std::size_t left_;
  std::size_t max_name_length_;
  std::string failure_;
};

}  // namespace box_query
