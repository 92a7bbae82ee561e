// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Queries of rays and segments against a set of boxes.
#pragma once

#include <box_query/geometry.h>
#include <box_query/intersection.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace box_query {

/// Index that stands for "no box".
constexpr std::size_t kNoBox = std::numeric_limits<std::size_t>::max();

/// Which boxes of a scene a query looks at.
class BoxMask {
 public:
  /// A mask for `size` boxes that looks at all of them, or at none.
  explicit BoxMask(std::size_t size, bool all = true);

  std::size_t size() const noexcept { return size_; }
  bool operator[](std::size_t box) const noexcept {
    return ((words_[box / 64] >> (box % 64)) & 1U) != 0;
  }
  void set(std::size_t box, bool look) noexcept;
  /// Bit i % 64 of word i / 64 says whether to look at box i.
  const std::uint64_t* words() const noexcept { return words_.data(); }

 private:
  std::size_t size_;
  std::vector<std::uint64_t> words_;
};

/// Closest hit of a ray.
struct Hit {
  /// Has the last word: a hit that is farther away than a double can say has range +inf too.
  bool hit = false;
  /// Index of the box that is entered first, the lowest one on a tie; kNoBox on a miss.
  std::size_t box = kNoBox;
  /// Distance [m] along the ray to where it enters and leaves that box, correctly rounded; entry 0
  /// where it starts inside. On a miss +inf and NaN.
  double range = std::numeric_limits<double>::infinity();
  double exit_range = std::numeric_limits<double>::quiet_NaN();
  /// The parameter of the entry, a multiple of the ray's direction.
  double t = std::numeric_limits<double>::infinity();
  /// The origin lies in the closed solid.
  bool started_inside = false;
  FaceSet entered;
  /// Where the ray enters, and the outward unit normal of the entered face: that of the lowest axis
  /// on an edge or a corner, zero where the ray starts inside. NaN on a miss.
  Vector3 point = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 normal = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// The closest box of a ray, and no more than an enclosure of where it is entered.
struct ClosestBox {
  bool hit = false;
  /// Index of the box that is entered first, the lowest one on a tie; kNoBox on a miss.
  std::size_t box = kNoBox;
  /// The parameter of entry, a multiple of the ray's direction, is certainly in [t_lower, t_upper]:
  /// as a rule apart by a few units in the last place of the largest coordinate.
  double t_lower = std::numeric_limits<double>::infinity();
  double t_upper = std::numeric_limits<double>::infinity();
};

/// One of the boxes that a component meets.
struct BoxIntersection {
  std::size_t box = kNoBox;
  Intersection intersection;
};

/// The box nearest to a segment.
struct Clearance {
  /// Lowest index among the nearest; kNoBox if the query looks at no box.
  std::size_t box = kNoBox;
  /// Exact distance, correctly rounded; 0 if they meet, +inf without a box.
  double distance = std::numeric_limits<double>::infinity();
  /// Smallest parameter in [0, 1] at which it is attained, and the points there; NaN without a box.
  double t = std::numeric_limits<double>::quiet_NaN();
  Vector3 on_segment = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 on_box = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// The first place along a segment that is too close to a box.
struct Blockage {
  /// Some box is within the radius. Decided exactly.
  bool blocked = false;
  /// The box with the smallest blocked_at, the lowest index on a tie; kNoBox if not blocked.
  std::size_t box = kNoBox;
  /// Smallest parameter in [0, 1] whose point is within the radius of a box: see blockedAt(); +inf
  /// if not blocked.
  double blocked_at = std::numeric_limits<double>::infinity();
};

/// How a scene was made from the one before: see Scene::updated().
struct SceneUpdate {
  /// Everything was organised anew, which is what the constructor does.
  bool rebuilt = true;
  /// Boxes that were other ones before, that were not there, and that are not here any more.
  std::size_t moved = 0;
  std::size_t added = 0;
  std::size_t removed = 0;
};

/// Which kernels scenes use: "avx512", "avx2" or "portable". They are the widest that the CPU has,
/// or those that the environment variable BOX_QUERY_KERNEL names; answers are the same bits with
/// each, but for the enclosures of castClosest().
const char* activeKernels() noexcept;
/// Whether BOX_QUERY_KERNEL names kernels that there are not, or that this CPU cannot run: then it
/// is as if it were not set.
bool isKernelChoiceRefused() noexcept;

/// The largest range [m] of each of several rays: >= 0, +inf where it is unlimited.
class MaxRanges {
 public:
  /// The same for all of them.
  MaxRanges(double same) : same_(same) {}  // NOLINT(google-explicit-constructor): ranges may be one
  /// An array with one for each ray, which outlives this.
  explicit MaxRanges(const double* each) : each_(each) {}

  double operator[](std::size_t ray) const { return each_ != nullptr ? each_[ray] : same_; }
  /// That of a ray, and how far behind it that of the next ray is.
  const double* from(std::size_t ray) const { return each_ != nullptr ? each_ + ray : &same_; }
  std::size_t distance() const { return each_ != nullptr ? 1 : 0; }

 private:
  double same_ = 0.0;
  const double* each_ = nullptr;
};

/// An immutable set of boxes. All queries are const, take no lock and may run on any number of
/// threads.
///
/// Copies are cheap: they share what never changes. A scene that was moved from may only be
/// assigned to or destroyed.
///
/// A box is known by its index in the vector that the scene was made from. Answers do not depend on
/// how the scene is organised inside. `mask`, where it is not null, has as many entries as the
/// scene has boxes.
class Scene {
 public:
  Scene();
  /// @throws std::invalid_argument naming the first box that is not valid.
  explicit Scene(std::vector<Box> boxes);
  ~Scene();
  Scene(const Scene&);
  Scene& operator=(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The scene of other boxes: the same as a new one, made in less time where most of them are
  /// boxes of this scene, unchanged or moved. It is organised like this one, with new bounds; where
  /// that would be bad for queries, anew.
  /// @param previous of each box its index in this scene, no index twice, or kNoBox for a box that
  /// was not there
  /// @throws std::invalid_argument naming the first box that is not valid, or where `previous` is
  /// not as above.
  Scene updated(std::vector<Box> boxes, const std::vector<std::size_t>& previous) const;

  /// How it was made.
  const SceneUpdate& update() const noexcept;

  std::size_t size() const noexcept;
  const std::vector<Box>& boxes() const noexcept;

  /// The box that the ray meets first, among those that it meets at a range of at most `max_range`
  /// metres along it.
  /// @pre isValid(ray), max_range >= 0 (+inf: unlimited)
  Hit cast(const Ray& ray, double max_range = std::numeric_limits<double>::infinity(),
           const BoxMask* mask = nullptr) const noexcept;

  /// The box that cast() says, decided exactly, but nothing about it is rounded: in much less time,
  /// for those that want to know which box, or where without the last digits.
  /// @pre isValid(ray), max_range >= 0 (+inf: unlimited)
  ClosestBox castClosest(const Ray& ray, double max_range = std::numeric_limits<double>::infinity(),
                         const BoxMask* mask = nullptr) const noexcept;

  /// The same of `count` rays one after the other, with the same answers: where there are many
  /// boxes in less time, since several of them are under way at once. See batch.h for all cores.
  /// @pre isValid() of each
  void cast(const Ray* rays, std::size_t count, Hit* hits,
            MaxRanges max_ranges = std::numeric_limits<double>::infinity(),
            const BoxMask* mask = nullptr) const noexcept;
  void castClosest(const Ray* rays, std::size_t count, ClosestBox* closest,
                   MaxRanges max_ranges = std::numeric_limits<double>::infinity(),
                   const BoxMask* mask = nullptr) const noexcept;
  /// 1 for true.
  void castAny(const Ray* rays, std::size_t count, std::uint8_t* any,
               MaxRanges max_ranges = std::numeric_limits<double>::infinity(),
               const BoxMask* mask = nullptr) const noexcept;

  /// Whether the ray meets any box at a range of at most `max_range`. Never says which.
  bool castAny(const Ray& ray, double max_range = std::numeric_limits<double>::infinity(),
               const BoxMask* mask = nullptr) const noexcept;

  /// Every box that the component meets, sorted by exact entry, then by index.
  std::vector<BoxIntersection> findAll(const Line& line, const BoxMask* mask = nullptr) const;
  std::vector<BoxIntersection> findAll(const Ray& ray, const BoxMask* mask = nullptr) const;
  std::vector<BoxIntersection> findAll(const Segment& segment, const BoxMask* mask = nullptr) const;

  /// Whether every box is farther than `radius` [m] from the segment.
  /// @pre isValid(segment), radius finite and >= 0
  bool isClear(const Segment& segment, double radius, const BoxMask* mask = nullptr) const noexcept;
  /// The same of `count` segments, 1 for true, of radius 0 several of them under way at once.
  /// @param clear as many as segments
  void isClear(const Segment* segments, std::size_t count, std::uint8_t* clear, double radius,
               const BoxMask* mask = nullptr) const noexcept;

  /// The nearest box, by exact distance.
  Clearance clearance(const Segment& segment, const BoxMask* mask = nullptr) const noexcept;
  /// The same of `count` segments, several of them under way at once.
  /// @param clearances as many as segments
  void clearance(const Segment* segments, std::size_t count, Clearance* clearances,
                 const BoxMask* mask = nullptr) const noexcept;

  /// The first place along the segment within `radius` of a box: another box, often, than the
  /// nearest one.
  Blockage firstBlockage(const Segment& segment, double radius,
                         const BoxMask* mask = nullptr) const noexcept;

 private:
  struct Impl;
  explicit Scene(std::shared_ptr<const Impl> impl);

  std::shared_ptr<const Impl> impl_;
};

}  // namespace box_query
