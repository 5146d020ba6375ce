# SPDX-License-Identifier: Apache-2.0
# OpenImageIO without its package configuration, which on Debian 12 lists the include directory of OpenCV whether
# or not that is installed, and stops CMake. Defines OpenImageIOBare::OpenImageIO.
find_path(OpenImageIOBare_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIOBare_LIBRARY OpenImageIO)
find_library(OpenImageIOBare_UTIL_LIBRARY OpenImageIO_Util)
mark_as_advanced(OpenImageIOBare_INCLUDE_DIR OpenImageIOBare_LIBRARY OpenImageIOBare_UTIL_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIOBare
  REQUIRED_VARS OpenImageIOBare_LIBRARY OpenImageIOBare_UTIL_LIBRARY OpenImageIOBare_INCLUDE_DIR)
if(OpenImageIOBare_FOUND AND NOT TARGET OpenImageIOBare::OpenImageIO)
  add_library(OpenImageIOBare::OpenImageIO UNKNOWN IMPORTED)
  set_target_properties(OpenImageIOBare::OpenImageIO PROPERTIES
    IMPORTED_LOCATION ${OpenImageIOBare_LIBRARY}
    INTERFACE_LINK_LIBRARIES ${OpenImageIOBare_UTIL_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OpenImageIOBare_INCLUDE_DIR})
endif()
