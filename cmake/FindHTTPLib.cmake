# SPDX-License-Identifier: Apache-2.0
# cpp-httplib as Debian packages it: compiled, with only a pkg-config file. The definitions must be those with which
# the library was compiled. Defines HTTPLib::HTTPLib.
find_package(PkgConfig REQUIRED)
pkg_check_modules(HTTPLib_PC QUIET cpp-httplib)
find_path(HTTPLib_INCLUDE_DIR httplib.h HINTS ${HTTPLib_PC_INCLUDE_DIRS})
find_library(HTTPLib_LIBRARY cpp-httplib HINTS ${HTTPLib_PC_LIBRARY_DIRS})
set(HTTPLib_VERSION ${HTTPLib_PC_VERSION})
mark_as_advanced(HTTPLib_INCLUDE_DIR HTTPLib_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HTTPLib REQUIRED_VARS HTTPLib_LIBRARY HTTPLib_INCLUDE_DIR VERSION_VAR HTTPLib_VERSION)
if(HTTPLib_FOUND AND NOT TARGET HTTPLib::HTTPLib)
  add_library(HTTPLib::HTTPLib UNKNOWN IMPORTED)
  set_target_properties(HTTPLib::HTTPLib PROPERTIES
    IMPORTED_LOCATION ${HTTPLib_LIBRARY}
    INTERFACE_COMPILE_OPTIONS "${HTTPLib_PC_CFLAGS_OTHER}"
    INTERFACE_INCLUDE_DIRECTORIES ${HTTPLib_INCLUDE_DIR})
endif()
