// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <boost/shared_ptr.hpp>

namespace box_query {

/// Notices that the publishers of one topic have all made way for new ones, by a restart say: what
/// the former ones said is to be forgotten then. While one of them is still there nothing is, nor
/// where only a connection was lost and made anew. Not thread safe.
class Succession {
 public:
  using Clock = std::chrono::steady_clock;
  using Header = std::map<std::string, std::string>;
  using Connection = boost::shared_ptr<const Header>;
  using Addresses = std::set<std::string>;

  /// Those of this node: publishers in its process share its address, but connections to them are
  /// not lost.
  Succession(std::string own_name, std::string own_address)
      : own_name_(std::move(own_name)), own_address_(std::move(own_address)) {}

  /// Whether no message has come through that connection yet.
  bool isNew(const Connection& connection) const { return heard_.count(connection) == 0; }

  /// The first message comes through that connection, while these publishers are connected; what
  /// came before has words up to `last_word`.
  void hear(const Connection& connection, Addresses publishers, std::uint64_t last_word,
            Clock::time_point now);

  /// Whether look() should be called: a new publisher has spoken since the last look, or of late.
  /// The former one may go a little later than the new one comes.
  bool asks(Clock::time_point now) const { return !looked_ || now < asks_until_; }

  /// Whether there was a look since a new publisher spoke.
  bool isLooked() const { return looked_; }

  /// `publishers` are those that the topic has now: one that was restarted has another address.
  /// @return the last word to be forgotten, or nothing.
  std::optional<std::uint64_t> look(const Addresses& publishers);

 private:
  Addresses tellApart(Addresses publishers) const;

  std::string own_name_;
  std::string own_address_;
  int own_publishers_ = 0;       // that were heard, in this process
  std::set<Connection> heard_;   // holding them keeps their addresses from being used again
  Addresses publishers_;         // when the new one spoke
  Addresses former_;             // when the one before it did
  std::uint64_t last_word_ = 0;  // before that message
  bool looked_ = true;           // since the new one spoke
  Clock::time_point asks_until_{};
};

}  // namespace box_query
