// SPDX-License-Identifier: BSD-3-Clause
#include "ros/succession.h"

#include <algorithm>
#include <utility>

namespace box_query {
namespace {

constexpr std::chrono::seconds kHandover(1);

}  // namespace

void Succession::hear(const Connection& connection, Addresses publishers, std::uint64_t last_word,
                      Clock::time_point now) {
  for (auto each = heard_.begin(); each != heard_.end();) {
    each = each->unique() ? heard_.erase(each) : std::next(each);  // closed
  }
  heard_.insert(connection);
  const auto name = connection->find("callerid");
  own_publishers_ += name != connection->end() && name->second == own_name_ ? 1 : 0;
  if (looked_) {
    former_ = std::move(publishers_);
    last_word_ = last_word;
    looked_ = false;
  }
  publishers_ = tellApart(std::move(publishers));
  asks_until_ = now + kHandover;
}

std::optional<std::uint64_t> Succession::look(const Addresses& publishers) {
  const Addresses there = tellApart(publishers);
  looked_ = true;
  const bool one_stays =
      std::any_of(former_.begin(), former_.end(),
                  [&there](const std::string& former) { return there.count(former) > 0; });
  if (one_stays) {
    return std::nullopt;
  }
  asks_until_ = {};
  return last_word_;
}

/// Of publishers in this process, which have one address, those that spoke last.
Succession::Addresses Succession::tellApart(Addresses publishers) const {
  if (publishers.erase(own_address_) > 0) {
    publishers.insert(own_address_ + " " + std::to_string(own_publishers_));
  }
  return publishers;
}

}  // namespace box_query
