// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every answer against the exact one for the scene that it names.
#pragma once

#include "load/clients.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace box_query::load {

struct Verdict {
  std::array<std::size_t, kServices> right{};
  std::size_t complete = 0;   ///< of them, that met a box in a complete scene
  std::size_t moved = 0;      ///< and that met one in a moving frame
  std::size_t by_oracle = 0;  ///< checked by the oracle too
  std::vector<double> ages;   ///< [ms] of the scenes that they are from, when they were asked
  std::vector<std::string> wrong;
  /// Rightly: the transform of a request that came at once had not come within ~transform_timeout.
  std::vector<std::string> refused;
  std::size_t unknown_scenes = 0;  ///< answers from scenes that ~get_scene did not give

  std::size_t rights() const;
};

/// Each must be, to the last bit, what the library answers from the boxes that were published, by
/// the message of each topic that ~get_scene names; every `oracle_step`-th is checked against the
/// oracle too, which shares nothing with the library.
Verdict check(const std::vector<Answer>& answers, const std::map<std::uint64_t, SceneFacts>& scenes,
              std::size_t oracle_step, unsigned threads);

}  // namespace box_query::load
