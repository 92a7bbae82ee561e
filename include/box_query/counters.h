// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What queries had to do, and so what they were spared.
#pragma once

#include <cstdint>

namespace box_query {

/// Numbers that only grow: take the difference of two to know what happened in between.
struct QueryCounters {
  /// Comparisons in float of sixteen bounds, or of eight whole boxes of a small scene. What these
  /// exclude is not looked at again.
  std::uint64_t nodes = 0;
  /// Boxes of scenes that were compared in double.
  std::uint64_t boxes = 0;
  /// Of these, boxes that are turned: others are not rotated for.
  std::uint64_t turned_boxes = 0;
  /// Decisions that double left open, about a box or between two: made in double-double or by a
  /// shortcut.
  std::uint64_t certified_decisions = 0;
  /// Decisions that these left open too, made in exact integers.
  std::uint64_t exact_decisions = 0;
  /// Numbers of an answer that were so near to the middle between two doubles that exact integers
  /// had to round them.
  std::uint64_t exact_roundings = 0;
};

QueryCounters& operator+=(QueryCounters& a, const QueryCounters& b) noexcept;
QueryCounters operator-(const QueryCounters& a, const QueryCounters& b) noexcept;

/// What the calling thread did since it began, in all queries of single boxes and of scenes. A
/// batch works on other threads too: see BatchOptions::counters.
QueryCounters queryCounters() noexcept;

}  // namespace box_query
