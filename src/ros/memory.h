// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Memory of a process that is the node alone. Each page that it gets from the system takes a
/// microsecond or two, of which a new scene has hundreds.
#pragma once

#include <cstddef>

namespace box_query {

/// Has malloc keep what is freed for the next request, up to 16 MB an arena. glibc would hand the
/// megabytes of a large batch back to the system after every call, and get them page by page for
/// the next.
void keepFreedMemory();

/// Where freed memory is kept: gets so many bytes, 8 MB at most, from the system for what the
/// calling thread will allocate. For when nobody waits.
void makeMemoryReady(std::size_t bytes);

}  // namespace box_query
