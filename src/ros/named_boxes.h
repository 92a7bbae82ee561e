// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes by name, as responses carry them.
#pragma once

#include <box_query/ros/scene_monitor.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace box_query {

template <class Response>
void appendName(const BoxName& name, Response& response) {
  response.box_topics.push_back(name.topic);
  response.box_namespaces.push_back(name.ns);
  response.box_ids.push_back(name.id);
  response.box_labels.push_back(name.label);
}

/// Renumbers `indices`, which are those of the scene or -1, and lists the boxes that they name in
/// the response: each once, in the order of the scene.
template <class Response>
void nameBoxes(const Snapshot& snapshot, std::initializer_list<std::vector<std::int32_t>*> indices,
               Response& response) {
  std::vector<std::int32_t> boxes;
  for (const auto* array : indices) {
    std::copy_if(array->begin(), array->end(), std::back_inserter(boxes),
                 [](std::int32_t box) { return box >= 0; });
  }
  std::sort(boxes.begin(), boxes.end());
  boxes.erase(std::unique(boxes.begin(), boxes.end()), boxes.end());
  for (auto* array : indices) {
    for (std::int32_t& box : *array) {
      if (box >= 0) {
        box = static_cast<std::int32_t>(std::lower_bound(boxes.begin(), boxes.end(), box) -
                                        boxes.begin());
      }
    }
  }
  for (const std::int32_t box : boxes) {
    appendName(snapshot.names[static_cast<std::size_t>(box)], response);
  }
}

}  // namespace box_query
