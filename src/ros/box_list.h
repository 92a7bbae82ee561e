// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes with their ids, in the form in which a message brings them.
#pragma once

#include "ros/magnitudes.h"
#include "ros/wire_reader.h"

#include <box_query/geometry.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <boost/container/small_vector.hpp>

namespace box_query {

struct IdentifiedBox {
  // Not defaulted: emplace_back() would fill it with zeros first.
  IdentifiedBox() {}  // NOLINT(modernize-use-equals-default): of any numbers
  IdentifiedBox(std::int64_t box_id, const Vector3& center, const Quaternion& orientation,
                const Vector3& half_extents)
      : id(box_id), box{center, orientation, half_extents} {}

  std::int64_t id;
  OrientedBox box;
};

/// The boxes of one change: each in full, or a shape and its places, a third of the memory.
class BoxList {
 public:
  /// Most markers are one box.
  using Each = boost::container::small_vector<IdentifiedBox, 1>;

  /// Reads boxes in any order. What turns the points of a list is made once for all of them, when
  /// somebody wants them: many lists are overtaken before.
  class Reader {
   public:
    explicit Reader(const BoxList& list);
    IdentifiedBox operator[](std::size_t n) const {
      return list_->points_.empty() ? list_->each_[n] : ofPoint(n);
    }

   private:
    IdentifiedBox ofPoint(std::size_t n) const {
      const OrientedBox& shape = list_->each_.front().box;
      const Vector3& point = list_->points_[n];
      const Vector3 offset = turned_ ? Vector3(rotation_ * point) : point;
      return {list_->id(n), shape.center + offset, shape.orientation, shape.half_extents};
    }

    const BoxList* list_;
    bool turned_ = false;
    Eigen::Matrix3d rotation_;  ///< if turned
  };

  class Iterator {
   public:
    Iterator(const BoxList& list, std::size_t n) : reader_(list), n_(n) {}
    IdentifiedBox operator*() const { return reader_[n_]; }
    Iterator& operator++() {
      ++n_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return n_ != other.n_; }

   private:
    Reader reader_;
    std::size_t n_;
  };

  std::size_t size() const { return points_.empty() ? each_.size() : points_.size(); }
  bool empty() const { return size() == 0; }
  std::int64_t id(std::size_t n) const {
    return points_.empty() ? each_[n].id : each_.front().id + (static_cast<std::int64_t>(n) << 32);
  }
  /// Of many boxes a Reader makes less.
  IdentifiedBox operator[](std::size_t n) const { return Reader(*this)[n]; }
  IdentifiedBox front() const { return (*this)[0]; }
  IdentifiedBox back() const { return (*this)[size() - 1]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

  void clear() { *this = BoxList(); }
  /// The boxes to be changed, each in full from now on.
  Each& each() {
    if (!points_.empty()) {
      spreadPoints();
    }
    return each_;
  }
  /// Box n is the shape with its center at point n of its frame, and has the id first_id + n *
  /// 2^32. Where the shape is not turned and stands at 0, points are taken as they are, to the last
  /// bit.
  void setPoints(std::int64_t first_id, const OrientedBox& shape, const WireArray& points);
  bool arePoints() const { return !points_.empty(); }
  /// Bit for bit and in the same form: no reader of a snapshot could tell them apart.
  bool isSame(const BoxList& other) const;

 private:
  void spreadPoints();

  Each each_;                    ///< of points: the shape, with the first id
  std::vector<Vector3> points_;  ///< empty: as `each_` says
};

/// Whether a shape of that center and orientation is isWithin() the limit at each of some points of
/// its frame; false where it would take a look at each.
bool areSurelyWithin(double max_coordinate, const Vector3& center, const Quaternion& orientation,
                     const Magnitudes& points);

}  // namespace box_query
