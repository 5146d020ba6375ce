// SPDX-License-Identifier: Apache-2.0
#include "cli/version.h"

namespace pelage {

const char* version() { return PELAGE_VERSION; }

}  // namespace pelage
