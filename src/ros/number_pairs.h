// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Two numbers at once, as wide as the instructions of every x86-64 CPU. Three are two pairs that
/// share one.
#pragma once

#include <cstdint>
#include <cstring>

namespace box_query {

using NumberPair [[gnu::vector_size(16)]] = double;
using BitsPair [[gnu::vector_size(16)]] = std::uint64_t;

/// Of bytes at any place.
inline NumberPair loadPair(const void* bytes) {
  NumberPair pair;
  std::memcpy(&pair, bytes, sizeof(pair));
  return pair;
}

inline void storePair(const NumberPair& pair, double* numbers) {
  std::memcpy(numbers, &pair, sizeof(pair));
}

}  // namespace box_query
