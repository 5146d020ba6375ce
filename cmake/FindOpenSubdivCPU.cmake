# SPDX-License-Identifier: Apache-2.0
# OpenSubdiv's CPU library. Debian 12's own package configuration names a static library that no package ships
# and stops CMake, hence this module. Defines OpenSubdivCPU::OpenSubdivCPU.
find_path(OpenSubdivCPU_INCLUDE_DIR opensubdiv/far/topologyRefiner.h)
find_library(OpenSubdivCPU_LIBRARY osdCPU)
if(OpenSubdivCPU_INCLUDE_DIR)
  file(STRINGS ${OpenSubdivCPU_INCLUDE_DIR}/opensubdiv/version.h version REGEX "define OPENSUBDIV_VERSION_NUMBER")
  if(version MATCHES "([0-9]+)0([0-9])0([0-9])$")
    set(OpenSubdivCPU_VERSION ${CMAKE_MATCH_1}.${CMAKE_MATCH_2}.${CMAKE_MATCH_3})
  endif()
endif()
mark_as_advanced(OpenSubdivCPU_INCLUDE_DIR OpenSubdivCPU_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdivCPU REQUIRED_VARS OpenSubdivCPU_LIBRARY OpenSubdivCPU_INCLUDE_DIR)
if(OpenSubdivCPU_FOUND AND NOT TARGET OpenSubdivCPU::OpenSubdivCPU)
  add_library(OpenSubdivCPU::OpenSubdivCPU UNKNOWN IMPORTED)
  set_target_properties(OpenSubdivCPU::OpenSubdivCPU PROPERTIES
    IMPORTED_LOCATION ${OpenSubdivCPU_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OpenSubdivCPU_INCLUDE_DIR})
endif()
