// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// How many of OpenEXR's own threads, of which a process has one team, a file asks for that may use
/// `threads`. One is the calling thread alone. Under the thread sanitizer none: they are not instrumented.
int exr_threads(int threads);

}  // namespace pelage
