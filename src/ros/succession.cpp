// SPDX-License-Identifier: BSD-3-Clause
#include "ros/succession.h"

#include <algorithm>
#include <utility>

namespace box_query {
namespace {

constexpr std::chrono::seconds kHandover(1);

}  // namespace

void Succession::hear(const Connection& connection, std::uint64_t last_word,
                      Clock::time_point now) {
  if (heard_.count(connection) > 0) {
    return;
  }
  for (auto each = heard_.begin(); each != heard_.end();) {
    each = each->unique() ? heard_.erase(each) : std::next(each);  // closed
  }
  heard_.insert(connection);
  const auto name = connection->find("callerid");
  own_publishers_ += name != connection->end() && name->second == own_name_ ? 1 : 0;
  if (looked_) {
    former_ = publishers_;
    last_word_ = last_word;
    looked_ = false;
  }
  asks_until_ = now + kHandover;
}

std::optional<std::uint64_t> Succession::look(Strings publishers) {
  publishers_ = std::move(publishers);
  const auto own = publishers_.find(own_name_);
  if (own != publishers_.end()) {
    own->second += " " + std::to_string(own_publishers_);
  }
  looked_ = true;
  const bool one_stays = std::any_of(former_.begin(), former_.end(), [this](const auto& former) {
    const auto now = publishers_.find(former.first);
    return now != publishers_.end() && now->second == former.second;
  });
  if (one_stays) {
    return std::nullopt;
  }
  asks_until_ = {};
  return last_word_;
}

}  // namespace box_query
