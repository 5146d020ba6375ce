// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/growth_identity.h"

#include "base/program_identity.h"

namespace pelage {

std::string growth_identity() {
  std::string identity(growth_sources());
  // Subdivision, and the functions of the C library, which depend on the processor. Only libraries that the
  // program starts with: others are loaded with the module that reads textures, and the identity must not
  // depend on whether one has been read.
  for (const char* library : {"libm.so", "libosdCPU.so"}) identity += " " + library_identity(library);
#ifdef __x86_64__
  if (__builtin_cpu_supports("fma")) identity += " fma";
  if (__builtin_cpu_supports("avx2")) identity += " avx2";
  if (__builtin_cpu_supports("avx512f")) identity += " avx512f";
#endif
  return identity;
}

}  // namespace pelage
