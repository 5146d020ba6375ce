# SPDX-License-Identifier: Apache-2.0
# install, and what find_package(pelage) needs afterwards.
include(CMakePackageConfigHelpers)

# What others may build on (docs/LIBRARY.md). Only these headers are installed, and what they include.
set(public_headers
  base/error.h base/schema.h base/stop_switch.h base/stopwatch.h base/version.h
  image/exr.h
  geom/strands.h geom/curve_bounds.h geom/io/host_geometry.h image/host_image.h geom/io/strand_file.h geom/io/strand_reader.h
  procedurals/fixed_strands.h
  render/fibre/fibre_material.h render/frame/frame_saver.h render/frame/frame_watch.h render/material/material.h
  post/pelage_post.h
  world/grow_coat.h world/scene_session.h world/world.h)
set(installed_headers)
while(public_headers)
  list(POP_FRONT public_headers header)
  if(header IN_LIST installed_headers)
    continue()
  endif()
  list(APPEND installed_headers ${header})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pelage/${folder})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  file(STRINGS ${PROJECT_SOURCE_DIR}/${header} includes REGEX "^#include \"")
  list(TRANSFORM includes REPLACE "^#include \"([^\"]+)\".*" "\\1")
  list(APPEND public_headers ${includes})
endwhile()
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pelage)
configure_package_config_file(cmake/pelageConfig.cmake.in ${CMAKE_BINARY_DIR}/pelageConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/pelageConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT pelage NAMESPACE pelage:: FILE pelageTargets.cmake DESTINATION ${package_dir})
install(FILES ${CMAKE_BINARY_DIR}/pelageConfig.cmake ${CMAKE_BINARY_DIR}/pelageConfigVersion.cmake
              cmake/PelageDependencies.cmake cmake/FindOpenSubdivCPU.cmake cmake/FindXXHash.cmake
        DESTINATION ${package_dir})
