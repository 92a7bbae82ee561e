// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Names of tf frames as messages bring them.
#pragma once

#include <string>
#include <string_view>

#include <boost/container/small_vector.hpp>

namespace box_query {

/// A frame as tf2 wants it: publishers of the days of tf1 lead with a slash, which tf2 refuses.
/// The result is a view into `frame`.
inline std::string_view stripSlash(std::string_view frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

/// Whether a frame without its leading slash is empty, or one that tf2 would still refuse.
inline bool isBadFrame(std::string_view frame) {
  return frame.empty() || frame.front() == '/';
}

/// The name of a frame, without an allocation unless it is longer than robots' frames are. Every
/// change has one: an allocation took a third of the time to decode a message of a few boxes.
class FrameName {
 public:
  FrameName() = default;
  explicit FrameName(std::string_view name) : text_(name.begin(), name.end()) {}
  FrameName& operator=(std::string_view name) {
    text_.assign(name.begin(), name.end());
    return *this;
  }
  // NOLINTNEXTLINE(google-explicit-constructor): it is one
  operator std::string_view() const { return {text_.data(), text_.size()}; }
  std::string str() const { return {text_.begin(), text_.end()}; }
  std::size_t size() const { return text_.size(); }

 private:
  boost::container::small_vector<char, 40> text_;
};

inline bool operator==(const FrameName& a, std::string_view b) {
  return std::string_view(a) == b;
}

}  // namespace box_query
