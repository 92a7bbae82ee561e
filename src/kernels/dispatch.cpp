// SPDX-License-Identifier: BSD-3-Clause
#include "kernels/kernels.h"

#include <cstdlib>
#include <cstring>

namespace box_query::kernels {
namespace {

#if defined(__x86_64__)
bool hasAvx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi");
}
bool hasAvx512() {
  return hasAvx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512dq");
}
#endif

const Kernels& widest() {
#if defined(__x86_64__)
  if (hasAvx512()) {
    return kAvx512;
  }
  if (hasAvx2()) {
    return kAvx2;
  }
#endif
  return kPortable;
}

struct Choice {
  const Kernels* kernels;
  bool refused;
};

Choice choose() {
  const char* name = std::getenv("BOX_QUERY_KERNEL");
  if (name == nullptr || *name == '\0') {
    return {&widest(), false};
  }
  const Kernels* named = byName(name);
  return named != nullptr ? Choice{named, false} : Choice{&widest(), true};
}

const Choice& choice() {
  static const Choice made = choose();
  return made;
}

}  // namespace

const Kernels* byName(const char* name) {
  if (std::strcmp(name, kPortable.name) == 0) {
    return &kPortable;
  }
#if defined(__x86_64__)
  if (std::strcmp(name, kAvx2.name) == 0 && hasAvx2()) {
    return &kAvx2;
  }
  if (std::strcmp(name, kAvx512.name) == 0 && hasAvx512()) {
    return &kAvx512;
  }
#endif
  return nullptr;
}

const Kernels& active() {
  return *choice().kernels;
}

bool isChoiceRefused() {
  return choice().refused;
}

}  // namespace box_query::kernels
