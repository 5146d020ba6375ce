// SPDX-License-Identifier: Apache-2.0
#include "image/exr_threads.h"

#include <OpenEXR/ImfThreading.h>

namespace pelage {

int exr_threads(int threads) {
#ifdef PELAGE_STD_THREADS
  threads = 0;
#endif
  threads = threads > 1 ? threads : 0;
  if (threads > Imf::globalThreadCount()) Imf::setGlobalThreadCount(threads);
  return threads;
}

}  // namespace pelage
