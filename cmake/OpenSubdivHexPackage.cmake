# SPDX-License-Identifier: Apache-2.0

# The package files, beside the libraries: find_package(OpenSubdivHex) reads them.
include(CMakePackageConfigHelpers)
set(packageDir ${CMAKE_INSTALL_LIBDIR}/cmake/OpenSubdivHex)

get_property(OPENSUBDIVHEX_NEEDS_OPENMP GLOBAL PROPERTY OPENSUBDIVHEX_NEEDS_OPENMP)
if(NOT OPENSUBDIVHEX_NEEDS_OPENMP)
  set(OPENSUBDIVHEX_NEEDS_OPENMP FALSE)
endif()
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/OpenSubdivHexConfig.cmake.in
  ${PROJECT_BINARY_DIR}/OpenSubdivHexConfig.cmake
  INSTALL_DESTINATION ${packageDir})
# Before version 1.0 a new minor version may change what is there.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/OpenSubdivHexConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)

install(EXPORT OpenSubdivHexTargets NAMESPACE OpenSubdivHex:: DESTINATION ${packageDir})
install(FILES
  ${PROJECT_BINARY_DIR}/OpenSubdivHexConfig.cmake
  ${PROJECT_BINARY_DIR}/OpenSubdivHexConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindOpenSubdiv.cmake
  DESTINATION ${packageDir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Beside the headers that name it.
install(FILES ${PROJECT_SOURCE_DIR}/far_ext/INDEXING.md
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/opensubdivhex/far_ext)
