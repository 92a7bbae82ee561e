// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "benchmark/answer.h"
#include "geometry/prepared_box.h"

#include <memory>

namespace box_query::benchmark {

/// A box as the library prepares it: what the filter reads, apart from what only slow stages do.
struct LibraryBox {
  Prepared<OrientedSlabs> filter;
  std::unique_ptr<const OrientedBox> slow;

  explicit LibraryBox(const OrientedBox& box)
      : filter(prepared(box)), slow(std::make_unique<const OrientedBox>(box)) {}

  const OrientedBox& box() const { return *slow; }
};

}  // namespace box_query::benchmark
