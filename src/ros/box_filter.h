// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which boxes a request looks at.
#pragma once

#include "ros/limits.h"

#include <box_query/ros/scene_monitor.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace box_query {

/// The filters that all requests share, as views. What each means is in srv/.
struct BoxFilter {
  template <class Request>
  explicit BoxFilter(const Request& request)
      : topics(request.topics),
        namespaces(request.namespaces),
        labels(request.labels),
        ignore_topics(request.ignore_topics),
        ignore_namespaces(request.ignore_namespaces),
        ignore_ids(request.ignore_ids) {}

  /// How many names are ignored: of a box, or of all boxes of a topic or a namespace.
  std::size_t ignored() const { return std::max(ignore_topics.size(), ignore_namespaces.size()); }
  bool filters() const {
    return !topics.empty() || !namespaces.empty() || !labels.empty() || ignored() > 0;
  }

  const std::vector<std::string>& topics;
  const std::vector<std::string>& namespaces;
  const std::vector<std::string>& labels;
  const std::vector<std::string>& ignore_topics;
  const std::vector<std::string>& ignore_namespaces;
  const std::vector<std::int64_t>& ignore_ids;
};

/// @throws std::invalid_argument if the arrays of ignored boxes do not fit together, or a name is
/// longer than that of any box.
void check(const BoxFilter& filter, const Limits& limits);

/// The boxes of the snapshot that pass, or nothing where nothing is filtered. Names that no box has
/// are no error.
/// @pre check(filter)
std::optional<BoxMask> maskOf(const BoxFilter& filter, const Snapshot& snapshot);

/// Whether the boxes that may pass are known: completeness() of the topics that they can be of. A
/// topic that the filter chooses and the snapshot does not listen to is not known either.
Completeness completenessOf(const BoxFilter& filter, const Snapshot& snapshot,
                            const ros::Time& now);

/// A sentence for the first topic of the filter that the snapshot does not listen to, and for the
/// first namespace, label and ignored name that no box has; empty if there are none. Nothing of
/// such a name need be there, so that it is no error; but who mistypes a name is told that all is
/// clear.
/// @pre check(filter)
std::string unknownNames(const BoxFilter& filter, const Snapshot& snapshot);

}  // namespace box_query
