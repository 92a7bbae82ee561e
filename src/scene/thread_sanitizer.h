// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace box_query {

/// An order of threads that a library guarantees into which ThreadSanitizer does not see, told to
/// it. In other builds nothing.
class UnseenOrder {
 public:
  /// What this thread has done until now happens before ...
  void release() {
#ifdef __SANITIZE_THREAD__
    __tsan_release(this);
#endif
  }
  /// ... what a thread does after this.
  void acquire() {
#ifdef __SANITIZE_THREAD__
    __tsan_acquire(this);
#endif
  }
};

}  // namespace box_query
