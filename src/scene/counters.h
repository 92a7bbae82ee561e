// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kernels/scene_view.h"

namespace box_query {

/// What kernels did on this thread, to be added to.
///
/// Of the model for libraries that are loaded with the program, one load away: a call of the
/// dynamic linker would cost a tenth of a short query. So few bytes are there for libraries that
/// come later too, as with nodelets. (And not thread_local, which would look each time whether it
/// is to be constructed.)
extern __attribute__((tls_model("initial-exec"),
                      visibility("hidden"))) __thread kernels::Work work_of_thread;

}  // namespace box_query
