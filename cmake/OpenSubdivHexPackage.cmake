# SPDX-License-Identifier: Apache-2.0

# The package files, beside the libraries: find_package(OpenSubdivHex) reads them.
include(CMakePackageConfigHelpers)
set(packageDir ${CMAKE_INSTALL_LIBDIR}/cmake/OpenSubdivHex)

get_property(OPENSUBDIVHEX_NEEDS_OPENMP GLOBAL PROPERTY OPENSUBDIVHEX_NEEDS_OPENMP)
if(NOT OPENSUBDIVHEX_NEEDS_OPENMP)
  set(OPENSUBDIVHEX_NEEDS_OPENMP FALSE)
endif()
get_property(OPENSUBDIVHEX_NEEDS_CUDA GLOBAL PROPERTY OPENSUBDIVHEX_NEEDS_CUDA)
if(NOT OPENSUBDIVHEX_NEEDS_CUDA)
  set(OPENSUBDIVHEX_NEEDS_CUDA FALSE)
endif()
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/OpenSubdivHexConfig.cmake.in
  ${PROJECT_BINARY_DIR}/OpenSubdivHexConfig.cmake
  INSTALL_DESTINATION ${packageDir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/OpenSubdivHexConfigVersion.cmake
  COMPATIBILITY ${OPENSUBDIVHEX_COMPATIBILITY})

# The same for pkg-config, with C++17 or later.  Paths are relative to the file, so that the tree may be
# moved, but for those of an OpenSubdiv outside the system's folders.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}"
  OUTPUT_VARIABLE pcLibDir)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_INCLUDEDIR BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}"
  OUTPUT_VARIABLE pcIncludeDir)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX
  BASE_DIRECTORY "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" OUTPUT_VARIABLE pcPrefix)
set(pcCflags "-I\${includedir}/opensubdivhex")
if(NOT OpenSubdiv_INCLUDE_DIR IN_LIST CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES)
  string(APPEND pcCflags " -I${OpenSubdiv_INCLUDE_DIR}")
endif()
set(pcLibs "-L\${libdir} -lopensubdivhex_bfr_ext -lopensubdivhex_osd_ext -lopensubdivhex_far_ext")
set(osdDir "$<TARGET_FILE_DIR:OpenSubdiv::osdCPU>")
string(APPEND pcLibs
  "$<$<NOT:$<IN_LIST:${osdDir},${CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES}>>: -L${osdDir}> -losdCPU")
get_target_property(libraryType far_ext TYPE)
if(libraryType STREQUAL "STATIC_LIBRARY")
  string(APPEND pcLibs " -pthread")
  if(OPENSUBDIVHEX_NEEDS_OPENMP)
    string(APPEND pcLibs " ${OpenMP_CXX_FLAGS}")
  endif()
endif()
file(READ ${PROJECT_SOURCE_DIR}/cmake/opensubdivhex.pc.in pcText)
string(CONFIGURE "${pcText}" pcText @ONLY)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/opensubdivhex.pc CONTENT "${pcText}")
install(FILES ${PROJECT_BINARY_DIR}/opensubdivhex.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

install(EXPORT OpenSubdivHexTargets NAMESPACE OpenSubdivHex:: DESTINATION ${packageDir}
  COMPONENT development)
install(FILES
  ${PROJECT_BINARY_DIR}/OpenSubdivHexConfig.cmake
  ${PROJECT_BINARY_DIR}/OpenSubdivHexConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindOpenSubdiv.cmake
  DESTINATION ${packageDir} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT licence)
# Beside the headers that name it.
install(FILES ${PROJECT_SOURCE_DIR}/far_ext/INDEXING.md
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/opensubdivhex/far_ext COMPONENT development)
# The guide, with the pages, pictures and programs that it leads to, in the folders of the repository.
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/far_ext/INDEXING.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/far_ext COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/regression/perf/RESULTS.md
  ${PROJECT_SOURCE_DIR}/regression/perf/DEVICE_RESULTS.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/regression/perf COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT development PATTERN "site" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tutorials DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT development PATTERN "CMakeLists.txt" EXCLUDE)

if(UNIX AND NOT APPLE)
  include(OpenSubdivHexDebian)
endif()
