# SPDX-License-Identifier: Apache-2.0
# cmake -D OUT=file.cpp -D ROOT=folder -D ROOMS=base,geom -D BUILD=text -P HashSources.cmake
# Writes a source file with the hash of all sources of these modules and of BUILD, for pelage::growth_identity().
string(REPLACE "," ";" ROOMS "${ROOMS}")
set(all "${BUILD}")
foreach(room IN LISTS ROOMS)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${room}/*.h ${ROOT}/${room}/*.cpp)
  list(SORT files)
  foreach(file IN LISTS files)
    file(SHA256 ${ROOT}/${file} hash)
    string(APPEND all "\n${file} ${hash}")
  endforeach()
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 32 hash)
file(WRITE ${OUT} "// Made by cmake/HashSources.cmake.
#include \"groom/cache/growth_identity.h\"

namespace pelage {

std::string_view growth_sources() { return \"${hash}\"; }

}  // namespace pelage
")
