// SPDX-License-Identifier: BSD-3-Clause
// The entry points that libFuzzer calls. With --write-seeds=DIRECTORY the program writes its corpus
// there and ends.
#include "fuzz/fuzz.h"

#include <cstring>
#include <fstream>

/// AddressSanitizer has an operator new of its own, and libFuzzer a limit: -malloc_limit_mb.
void box_query::fuzz::limitAllocations(std::size_t /*bytes*/) {}

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const char* const option = "--write-seeds=";
  for (int i = 1; i < *argc; ++i) {
    if (std::strncmp((*argv)[i], option, std::strlen(option)) == 0) {
      const std::string directory = (*argv)[i] + std::strlen(option);
      int number = 0;
      for (const box_query::fuzz::Bytes& seed : box_query::fuzz::corpus()) {
        std::ofstream file(directory + "/seed-" + std::to_string(number++), std::ios::binary);
        file.write(reinterpret_cast<const char*>(seed.data()),
                   static_cast<std::streamsize>(seed.size()));
        box_query::fuzz::require(file.good(), "seeds can be written to " + directory);
      }
      std::exit(0);
    }
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  box_query::fuzz::testOne(data, size);
  return 0;
}
