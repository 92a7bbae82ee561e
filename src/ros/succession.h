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
  using Strings = std::map<std::string, std::string>;
  using Connection = boost::shared_ptr<const Strings>;  ///< its header

  /// `own_name` is that of this node: publishers in its process share its address, but connections
  /// to them are not lost.
  explicit Succession(std::string own_name) : own_name_(std::move(own_name)) {}

  /// A message comes through that connection; what came before has words up to `last_word`.
  void hear(const Connection& connection, std::uint64_t last_word, Clock::time_point now);

  /// Whether look() should be called: a new publisher has spoken of late. The former one may go a
  /// little later than the new one comes.
  bool asks(Clock::time_point now) const { return now < asks_until_; }

  /// `publishers` are those that the topic has now, addresses by name.
  /// @return the last word to be forgotten, or nothing.
  std::optional<std::uint64_t> look(Strings publishers);

 private:
  std::string own_name_;
  int own_publishers_ = 0;       // that were heard, in this process
  std::set<Connection> heard_;   // holding them keeps their addresses from being used again
  Strings publishers_;           // at the last look
  Strings former_;               // the same before the first message of the new one
  std::uint64_t last_word_ = 0;  // before that message
  bool looked_ = true;           // since then
  Clock::time_point asks_until_{};
};

}  // namespace box_query
