// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which boxes a request looks at.
#pragma once

#include <box_query/ros/scene_monitor.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace box_query {

/// The filters that all requests share, as views.
struct BoxFilter {
  template <class Request>
  explicit BoxFilter(const Request& request)
      : namespaces(request.namespaces),
        ignore_topics(request.ignore_topics),
        ignore_namespaces(request.ignore_namespaces),
        ignore_ids(request.ignore_ids) {}

  const std::vector<std::string>& namespaces;
  const std::vector<std::string>& ignore_topics;
  const std::vector<std::string>& ignore_namespaces;
  const std::vector<std::int64_t>& ignore_ids;
};

/// @throws std::invalid_argument if the arrays of ignored boxes do not fit together.
void check(const BoxFilter& filter);

/// A sentence that names the first of the filter's namespaces that no box of the snapshot has, and
/// those that there are; empty if every one has a box. Nothing of such a name need be there, so
/// that it is no error; but who mistypes a name is told that all is clear.
std::string unknownNamespace(const BoxFilter& filter, const Snapshot& snapshot);

/// The boxes of the snapshot that pass, or nothing where nothing is filtered. Names that no box has
/// are no error.
/// @pre check(filter)
std::optional<BoxMask> maskOf(const BoxFilter& filter, const Snapshot& snapshot);

}  // namespace box_query
