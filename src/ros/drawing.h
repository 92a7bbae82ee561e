// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What ~markers shows of the queries of one call.
#pragma once

#include <box_query/geometry.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace box_query {

enum class Outcome { kFree, kMet, kUnknown };

/// In the fixed frame. What is NaN is not drawn.
struct DrawnQuery {
  enum class Kind { kRay, kSegment };
  Kind kind = Kind::kRay;
  Outcome outcome = Outcome::kUnknown;
  Vector3 start;  ///< of the part of the component that is drawn
  Vector3 end;
  Vector3 hit = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< first contact
  Vector3 normal = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 on_segment = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 on_box = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// At most `limit` of them; 0 where nobody looks, and then nothing is made.
class Drawing {
 public:
  explicit Drawing(std::size_t limit = 0) : limit_(limit) {}

  bool full() const { return queries_.size() >= limit_; }
  /// @pre !full()
  void add(const DrawnQuery& query) { queries_.push_back(query); }
  std::vector<DrawnQuery> take() { return std::move(queries_); }

 private:
  std::size_t limit_;
  std::vector<DrawnQuery> queries_;
};

}  // namespace box_query
