// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The listings of the paper as methods of the benchmark, in the order line, ray, segment.
#pragma once

#include "benchmark/answer.h"
#include "reference/listings.h"

namespace box_query::benchmark {

struct PaperMethod {
  using Prepared = listings::OrientedBox3;
  static Prepared prepare(const OrientedBox& box) { return listings::toOrientedBox3(box); }
};

struct TestInWorldFrame : PaperMethod {
  static constexpr const char* kName = "listing 1/3/5, test in world frame";
  static constexpr bool kGivesT = false;
  static constexpr bool kLooksAtT = false;
  static Answer ask(const Line& line, const Prepared& box) {
    return {listings::listing1::testIntersection(line, box)};
  }
  static Answer ask(const Ray& ray, const Prepared& box) {
    return {listings::listing3::testIntersection(ray, box)};
  }
  static Answer ask(const Segment& segment, const Prepared& box) {
    return {listings::listing5::testIntersection(listings::toCenteredSegment3(segment), box)};
  }
};

struct TestInBoxFrame : PaperMethod {
  static constexpr const char* kName = "listing 2/4/6, test in box frame";
  static constexpr bool kGivesT = false;
  static constexpr bool kLooksAtT = false;
  static Answer ask(const Line& line, const Prepared& box) {
    return {listings::listing2::testIntersection(line, box)};
  }
  static Answer ask(const Ray& ray, const Prepared& box) {
    return {listings::listing4::testIntersection(ray, box)};
  }
  static Answer ask(const Segment& segment, const Prepared& box) {
    return {listings::listing6::testIntersection(segment, box)};
  }
};

/// Asked for t: the points are not looked at.
struct Find : PaperMethod {
  static constexpr const char* kName = "listing 8/9/10, find";
  static constexpr bool kGivesT = true;
  static constexpr bool kLooksAtT = true;
  static Answer ask(const Line& line, const Prepared& box) {
    const listings::Found found = listings::listing8::findIntersection(line, box);
    return {found.num_points > 0, found.t[0]};
  }
  static Answer ask(const Ray& ray, const Prepared& box) {
    const listings::Found found = listings::listing9::findIntersection(ray, box);
    return {found.num_points > 0, found.t[0]};
  }
  /// Listing 10 measures t from the middle of the segment, in units of length.
  static Answer ask(const Segment& segment, const Prepared& box) {
    const listings::Found found = listings::listing10::findIntersection(segment, box);
    const double length = (segment.end - segment.start).norm();
    return {found.num_points > 0, (found.t[0] + length / 2.0) / length};
  }
};

}  // namespace box_query::benchmark
