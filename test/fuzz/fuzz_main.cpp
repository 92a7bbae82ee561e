// SPDX-License-Identifier: BSD-3-Clause
// Feeds a fuzz target its corpus, and random mutations of them, where there is no libFuzzer. Blind
// to coverage, but the same for every run of one seed.
//
//   PROGRAM [--runs N] [--seed S]
#include "fuzz/fuzz.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <random>

namespace box_query::fuzz {
namespace {

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed, std::vector<Bytes> seeds)
      : engine_(seed), seeds_(std::move(seeds)) {}

  Bytes next() {
    Bytes bytes = any(seeds_);
    for (std::size_t n = below(5); n > 0; --n) {
      mutate(bytes);
    }
    return bytes;
  }

 private:
  std::size_t below(std::size_t end) { return engine_() % end; }
  const Bytes& any(const std::vector<Bytes>& some) { return some[below(some.size())]; }

  template <typename Number>
  void write(Bytes& bytes, Number number) {
    if (bytes.size() >= sizeof(number)) {
      std::memcpy(&bytes[below(bytes.size() - sizeof(number) + 1)], &number, sizeof(number));
    }
  }

  void mutate(Bytes& bytes) {
    static const double kDoubles[] = {0.0,   -0.0,   1.0,        -1.0,     1e-3,     1e3,
                                      1e18,  5e-324, 2.3e-308,   1.7e308,  -1.7e308, 0.5,
                                      1e100, 0.1,    0.70710678, HUGE_VAL, NAN,      1e-100};
    static const std::uint32_t kLengths[] = {0,     1,          2,          255,
                                             65536, 0x7fffffff, 0x80000000, 0xffffffff};
    if (bytes.empty()) {
      bytes.push_back(static_cast<std::uint8_t>(engine_()));
      return;
    }
    const auto at = [&](std::size_t i) { return bytes.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t first = below(bytes.size());
    const std::size_t end = first + below(std::min<std::size_t>(bytes.size() - first, 64)) + 1;
    switch (below(8)) {
      case 0:
        bytes[first] = static_cast<std::uint8_t>(engine_());
        break;
      case 1:
        bytes[first] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 2:
        bytes.erase(at(first), at(end));
        break;
      case 3: {
        const Bytes part(at(first), at(end));
        bytes.insert(at(below(bytes.size() + 1)), part.begin(), part.end());
        break;
      }
      case 4:
        write(bytes, kDoubles[below(std::size(kDoubles))]);
        break;
      case 5:
        write(bytes, kLengths[below(std::size(kLengths))]);
        break;
      case 6:  // of another seed
        if (const Bytes& other = any(seeds_); !other.empty()) {
          const std::size_t size = std::min(bytes.size(), other.size());
          const std::size_t cut = below(size);
          std::copy(other.begin() + static_cast<std::ptrdiff_t>(cut),
                    other.begin() + static_cast<std::ptrdiff_t>(size), at(cut));
        }
        break;
      default:
        bytes.resize(first);
    }
  }

  std::mt19937_64 engine_;
  std::vector<Bytes> seeds_;
};

void run(std::uint64_t runs, std::uint64_t seed) {
  const std::vector<Bytes> all = corpus();
  // In blocks of their own size, so that a sanitizer sees what reads beyond.
  for (const Bytes& bytes : all) {
    testOne(Bytes(bytes).data(), bytes.size());
  }
  Mutator mutator(seed, all);
  for (std::uint64_t n = 0; n < runs; ++n) {
    const Bytes bytes = mutator.next();
    testOne(Bytes(bytes).data(), bytes.size());
  }
  std::printf("%zu inputs and %" PRIu64 " mutations of them, seed %" PRIu64 "\n", all.size(), runs,
              seed);
}

}  // namespace
}  // namespace box_query::fuzz

int main(int argc, char** argv) {
  std::uint64_t runs = 100000;
  std::uint64_t seed = 1;
  for (int i = 1; i < argc; ++i) {
    const bool is_runs = std::strcmp(argv[i], "--runs") == 0;
    if ((!is_runs && std::strcmp(argv[i], "--seed") != 0) || i + 1 == argc) {
      std::fprintf(stderr, "usage: %s [--runs N] [--seed S]\n", argv[0]);
      return 2;
    }
    (is_runs ? runs : seed) = std::strtoull(argv[++i], nullptr, 10);
  }
  box_query::fuzz::run(runs, seed);
  return 0;
}
