// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace box_query {

/// What the master knows of the publishers of a topic.
struct Publishers {
  std::size_t nodes = 0;
  std::string type;  ///< of the one that registered last
};

/// By topic; nothing if the master cannot be reached. Does not wait for one that is gone.
std::optional<std::map<std::string, Publishers>> askForPublishers();

/// The addresses of a topic's publishers by their names, as the master knows them: a node that was
/// restarted has a new one. Nothing as above.
std::optional<std::map<std::string, std::string>> addressesOfPublishers(const std::string& topic);

}  // namespace box_query
