// SPDX-License-Identifier: BSD-3-Clause
// What libFuzzer has found to reach more than the seeds is kept in one file a target (BQ_CORPUS,
// which test/fuzz/pack writes): of each input its length, four bytes, and its bytes.
#include "fuzz/fuzz.h"

#include <fstream>

namespace box_query::fuzz {

std::vector<Bytes> corpus() {
  std::vector<Bytes> all = seeds();
  std::ifstream file(BQ_CORPUS, std::ios::binary);
  require(file.good(), "there is a file " BQ_CORPUS);
  std::uint32_t size = 0;
  while (file.read(reinterpret_cast<char*>(&size), sizeof(size))) {
    Bytes bytes(size);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    require(file.good(), "it is whole");
    all.push_back(bytes);
  }
  return all;
}

}  // namespace box_query::fuzz
