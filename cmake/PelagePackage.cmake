# SPDX-License-Identifier: Apache-2.0
# A Debian package of the program, the library and the package for Python: tools/package_deb makes and tries it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Pelage developers <pelage@localhost>")
set(CPACK_PACKAGE_VENDOR Pelage)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(TARGET pelage_python)
  # _pelage is for the minor version of Python that built it.
  math(EXPR next_python "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
      "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy")
endif()
# Python writes compiled files beside the sources, which dpkg does not know.
file(WRITE ${CMAKE_BINARY_DIR}/prerm "#!/bin/sh\nrm -rf /usr/${PELAGE_PYTHON_DESTINATION}/pelage/__pycache__\n")
file(CHMOD ${CMAKE_BINARY_DIR}/prerm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/prerm)
# What a program that links the library needs (PelageDependencies.cmake).
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libosd-dev, libembree-dev, libopenexr-dev, libimath-dev, libyaml-cpp-dev, libtbb-dev, libhwy-dev, libfmt-dev, libcli11-dev, nlohmann-json3-dev, libboost-dev, libxxhash-dev, libpng-dev, zlib1g-dev")
include(CPack)
