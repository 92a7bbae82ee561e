// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Clients that ask one question after the other, and what they were answered.
#pragma once

#include "load/caller.h"
#include "load/scene_log.h"

#include <cstdint>
#include <string>
#include <vector>

namespace box_query::load {

constexpr std::size_t kClients = 16;

/// A question and what became of it.
struct Answer {
  std::uint64_t seed = 0;
  Tick asked = 0;  ///< with the seed: what was asked
  ros::Time start, end;
  std::uint8_t service = 0;
  bool persistent = false;
  bool first_try_failed = false;
  bool lost = false;
  std::uint64_t scene_id = 0;
  Bytes response;

  double milliseconds() const { return (end - start).toSec() * 1e3; }
};

/// What the node has said of itself in a response of any service but get_scene: they begin alike.
struct Said {
  bool success = false;
  std::string message;
  std::uint64_t scene_id = 0;
};
Said readSaid(const Bytes& response);

/// kClients threads, every second of which keeps its connections, ask for `seconds`. Whoever gets
/// no answer tries once more if its connection was a new one.
std::vector<Answer> ask(double seconds, unsigned seed, SceneLog& scenes);

}  // namespace box_query::load
