// SPDX-License-Identifier: Apache-2.0
#include "base/version.h"

namespace pelage {

const char* version() { return PELAGE_VERSION; }
int library_abi() { return kLibraryAbi; }
const char* compiler() { return PELAGE_COMPILER; }
const char* libraries() { return PELAGE_LIBRARIES; }

}  // namespace pelage
