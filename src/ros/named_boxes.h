// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes by name, as responses carry them.
#pragma once

#include <box_query/ros/scene_monitor.h>

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace box_query {

using BoxIndices = std::vector<std::int32_t>;

/// Replaces each index of a box in `arrays`, none of which is negative but for -1, which stays, by
/// the place of that index among those that there are.
/// @return these, each once, ascending
BoxIndices renumber(std::initializer_list<BoxIndices*> arrays);

template <class Response>
void appendName(const BoxName& name, Response& response) {
  response.box_topics.push_back(name.topic);
  response.box_namespaces.push_back(name.ns);
  response.box_ids.push_back(name.id);
  response.box_labels.push_back(name.label);
}

/// Renumbers `arrays`, of indices of the scene or -1, and lists the boxes that they name in the
/// response: each once, in the order of the scene.
template <class Response>
void nameBoxes(const Snapshot& snapshot, std::initializer_list<BoxIndices*> arrays,
               Response& response) {
  for (const std::int32_t box : renumber(arrays)) {
    appendName(snapshot.names[static_cast<std::size_t>(box)], response);
  }
}

}  // namespace box_query
