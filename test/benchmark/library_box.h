// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "benchmark/answer.h"
#include "geometry/prepared_box.h"

#include <memory>

namespace box_query::benchmark {

/// A box as the library prepares it: what the filter reads, apart from what only slow stages do.
struct LibraryBox {
  struct Slow {
    OrientedBox box;
    Rows rows;
  };
  Prepared<OrientedSlabs> filter;
  std::unique_ptr<const Slow> slow;

  const OrientedBox& box() const { return slow->box; }
};

inline LibraryBox libraryBox(const OrientedBox& box) {
  return {prepared(box), std::make_unique<LibraryBox::Slow>(
                             LibraryBox::Slow{box, doubleDoubleRows(box.orientation)})};
}

}  // namespace box_query::benchmark
