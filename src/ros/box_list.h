// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes with their ids, in the form in which a message brings them.
#pragma once

#include <box_query/geometry.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <boost/container/small_vector.hpp>

namespace box_query {

struct IdentifiedBox {
  IdentifiedBox() = default;  ///< of any numbers
  IdentifiedBox(std::int64_t box_id, const Vector3& center, const Quaternion& orientation,
                const Vector3& half_extents)
      : id(box_id), box{center, orientation, half_extents} {}

  std::int64_t id;
  OrientedBox box;
};

/// Boxes that differ only in their places: a third of the memory. Immutable.
class PointList {
 public:
  /// Box n is the shape with its center at point n of its frame, and has the id first_id + n *
  /// 2^32. Where the shape is not turned and stands at 0, points are taken as they are, to the last
  /// bit.
  PointList(std::int64_t first_id, const OrientedBox& shape, std::vector<Vector3>&& points);

  std::size_t size() const { return points_.size(); }
  std::int64_t id(std::size_t n) const { return first_id_ + (static_cast<std::int64_t>(n) << 32); }
  IdentifiedBox operator[](std::size_t n) const {
    const Vector3 offset = turned_ ? Vector3(rotation_ * points_[n]) : points_[n];
    return {id(n), shape_.center + offset, shape_.orientation, shape_.half_extents};
  }
  /// Whether the centers of all boxes are isWithin() the limit; false where it would take a look at
  /// each.
  bool isSurelyWithin(double max_coordinate) const;
  /// Bit for bit.
  bool isSame(const PointList& other) const;

 private:
  std::int64_t first_id_;
  OrientedBox shape_;
  bool turned_;
  Eigen::Matrix3d rotation_;
  std::vector<Vector3> points_;
};

/// The boxes of one change: each in full, or as a list of points says.
class BoxList {
 public:
  /// Most markers are one box.
  using Each = boost::container::small_vector<IdentifiedBox, 1>;

  class Iterator {
   public:
    Iterator(const BoxList& list, std::size_t n) : list_(&list), n_(n) {}
    IdentifiedBox operator*() const { return (*list_)[n_]; }
    Iterator& operator++() {
      ++n_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return n_ != other.n_; }

   private:
    const BoxList* list_;
    std::size_t n_;
  };

  BoxList() = default;
  explicit BoxList(std::shared_ptr<const PointList> points) : points_(std::move(points)) {}

  std::size_t size() const { return points_ ? points_->size() : each_.size(); }
  bool empty() const { return size() == 0; }
  std::int64_t id(std::size_t n) const { return points_ ? points_->id(n) : each_[n].id; }
  IdentifiedBox operator[](std::size_t n) const { return points_ ? (*points_)[n] : each_[n]; }
  IdentifiedBox front() const { return (*this)[0]; }
  IdentifiedBox back() const { return (*this)[size() - 1]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

  void clear() { *this = BoxList(); }
  /// The boxes to be changed, each in full from now on.
  Each& each() {
    if (points_) {
      spreadPoints();
    }
    return each_;
  }
  /// Bit for bit and in the same form: no reader of a snapshot could tell them apart.
  bool isSame(const BoxList& other) const;

 private:
  void spreadPoints();

  Each each_;
  std::shared_ptr<const PointList> points_;  ///< null: as `each_` says, else that is empty
};

}  // namespace box_query
