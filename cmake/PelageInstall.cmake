# SPDX-License-Identifier: Apache-2.0
# install, and what find_package(pelage) needs afterwards.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pelage)
configure_package_config_file(cmake/pelageConfig.cmake.in ${CMAKE_BINARY_DIR}/pelageConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/pelageConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT pelage NAMESPACE pelage:: FILE pelageTargets.cmake DESTINATION ${package_dir})
install(FILES ${CMAKE_BINARY_DIR}/pelageConfig.cmake ${CMAKE_BINARY_DIR}/pelageConfigVersion.cmake
              cmake/PelageDependencies.cmake cmake/FindOpenSubdivCPU.cmake cmake/FindXXHash.cmake
        DESTINATION ${package_dir})
