// SPDX-License-Identifier: BSD-3-Clause
#include "ros/limits.h"

#include <sstream>

namespace box_query {

Limits::Limits(const Parameters& parameters)
    : boxes(static_cast<std::size_t>(parameters.max_boxes_per_message)),
      queries(static_cast<std::size_t>(parameters.max_queries_per_call)),
      names(static_cast<std::size_t>(parameters.max_filter_names)),
      name_length(static_cast<std::size_t>(parameters.max_name_length)),
      coordinate(parameters.max_coordinate) {}

std::string allowedCoordinates(double max_coordinate) {
  std::ostringstream text;
  text << "give 0, or magnitudes from " << kSmallestCoordinate << " to " << max_coordinate
       << " m, or raise ~max_coordinate";
  return text.str();
}

}  // namespace box_query
