# SPDX-License-Identifier: Apache-2.0
#
# The installed package: the build tree is installed, moved to another place, and used from there.
# Included by the top level, whose whole install is tested.
set(consumerDir ${PROJECT_BINARY_DIR}/consumer)
add_test(NAME consumer.install
  COMMAND ${CMAKE_COMMAND}
    -D buildDir=${PROJECT_BINARY_DIR}
    -D sourceDir=${PROJECT_SOURCE_DIR}
    -D prefix=${consumerDir}/prefix
    -D config=$<CONFIG>
    -P ${PROJECT_SOURCE_DIR}/regression/consumer/install.cmake)
add_test(NAME consumer.build
  COMMAND ${CMAKE_CTEST_COMMAND}
    --build-and-test ${PROJECT_SOURCE_DIR}/regression/consumer ${consumerDir}/build
    --build-generator ${CMAKE_GENERATOR}
    --build-config $<CONFIG>
    --build-options
      -DwantedVersion=${PROJECT_VERSION}
      "-DCMAKE_PREFIX_PATH=${consumerDir}/prefix;${CMAKE_PREFIX_PATH}"
      -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
      -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
      -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}
      -DCMAKE_BUILD_TYPE=$<CONFIG>
      -DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE}
      -DOpenSubdiv_ROOT=${OpenSubdiv_ROOT}
      -DOpenSubdiv_DIR=${OpenSubdiv_DIR}
    --test-command ${consumerDir}/build/consumer)
set(present far_ext osd_ext bfr_ext)
set(absent "")
foreach(device IN ITEMS gl cuda)
  if(TARGET osd_ext_${device})
    list(APPEND present osd_ext_${device})
  else()
    list(APPEND absent osd_ext_${device})
  endif()
endforeach()
add_test(NAME consumer.components
  COMMAND ${CMAKE_COMMAND} --fresh
    -S ${PROJECT_SOURCE_DIR}/regression/consumer/components
    -B ${consumerDir}/components
    -G ${CMAKE_GENERATOR}
    "-Dpresent=${present}"
    "-Dabsent=${absent}"
    "-DCMAKE_PREFIX_PATH=${consumerDir}/prefix;${CMAKE_PREFIX_PATH}"
    -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
    -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}
    -DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE}
    -DOpenSubdiv_ROOT=${OpenSubdiv_ROOT}
    -DOpenSubdiv_DIR=${OpenSubdiv_DIR})
set_tests_properties(consumer.components PROPERTIES FIXTURES_REQUIRED installed)
find_program(OPENSUBDIVHEX_PKG_CONFIG NAMES pkgconf pkg-config)
mark_as_advanced(OPENSUBDIVHEX_PKG_CONFIG)
if(OPENSUBDIVHEX_PKG_CONFIG AND UNIX)
  separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
  add_test(NAME consumer.pkgconfig
    COMMAND ${CMAKE_COMMAND}
      -D pkgConfig=${OPENSUBDIVHEX_PKG_CONFIG}
      -D prefix=${consumerDir}/prefix
      -D libDir=${CMAKE_INSTALL_LIBDIR}
      -D version=${PROJECT_VERSION}
      -D compiler=${CMAKE_CXX_COMPILER}
      -D "flags=${flags}"
      -D source=${PROJECT_SOURCE_DIR}/regression/consumer/consumer.cpp
      -D program=${consumerDir}/consumerOfPkgConfig
      -P ${PROJECT_SOURCE_DIR}/regression/consumer/pkgConfig.cmake)
  set_tests_properties(consumer.pkgconfig PROPERTIES FIXTURES_REQUIRED installed)
endif()
set_tests_properties(consumer.install PROPERTIES FIXTURES_SETUP installed)
set_tests_properties(consumer.build PROPERTIES FIXTURES_REQUIRED installed)
# A program of version 1.0, by the table of new names.
add_test(NAME consumer.migration
  COMMAND ${CMAKE_COMMAND}
    -D sourceDir=${PROJECT_SOURCE_DIR}
    -D workDir=${consumerDir}/migration
    -D config=$<CONFIG>
    "-D options=-G${CMAKE_GENERATOR};-DCMAKE_PREFIX_PATH=${consumerDir}/prefix\;${CMAKE_PREFIX_PATH};-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER};-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS};-DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE};-DOpenSubdiv_ROOT=${OpenSubdiv_ROOT};-DOpenSubdiv_DIR=${OpenSubdiv_DIR}"
    -P ${PROJECT_SOURCE_DIR}/regression/consumer/migration/migration.cmake)
set_tests_properties(consumer.migration PROPERTIES FIXTURES_REQUIRED installed)
add_test(NAME consumer.guide
  COMMAND ${CMAKE_COMMAND} -D folder=${consumerDir}/prefix/${CMAKE_INSTALL_DOCDIR}
    -P ${PROJECT_SOURCE_DIR}/regression/guide/links.cmake)
set_tests_properties(consumer.guide PROPERTIES FIXTURES_REQUIRED installed)
# What compiles the headers: those of OpenSubdiv are the system's, ours are not.
get_target_property(opensubdivDirs OpenSubdiv::osdCPU INTERFACE_INCLUDE_DIRECTORIES)
list(REMOVE_ITEM opensubdivDirs ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
list(TRANSFORM opensubdivDirs PREPEND -isystem)
find_package(TBB CONFIG QUIET)
find_path(OPENSUBDIVHEX_GL_INCLUDE_DIR GL/gl.h)
mark_as_advanced(OPENSUBDIVHEX_GL_INCLUDE_DIR)
set(missing $<$<NOT:$<BOOL:${TBB_FOUND}>>:tbb> $<$<NOT:$<BOOL:${OPENSUBDIVHEX_GL_INCLUDE_DIR}>>:gl>)
set(notBuilt "")
if(NOT TARGET osd_ext_gl)
  list(APPEND notBuilt osd_ext/glRefinement)
endif()
if(NOT TARGET osd_ext_cuda)
  list(APPEND notBuilt osd_ext/cuda)
endif()
set(headersCommand ${CMAKE_COMMAND}
  -D sourceDir=${PROJECT_SOURCE_DIR}
  -D includeDir=${consumerDir}/prefix/${CMAKE_INSTALL_INCLUDEDIR}/opensubdivhex
  -D compiler=${CMAKE_CXX_COMPILER}
  -D "flags=${opensubdivDirs};${OpenMP_CXX_FLAGS}"
  -D "missing=${missing}")
add_test(NAME consumer.headers
  COMMAND ${headersCommand} -D "notBuilt=${notBuilt}"
    -P ${PROJECT_SOURCE_DIR}/regression/consumer/headers.cmake)
set_tests_properties(consumer.headers PROPERTIES FIXTURES_REQUIRED installed)
foreach(before IN ITEMS hostile xlib)
  add_test(NAME consumer.macros.${before}
    COMMAND ${headersCommand} -D workDir=${consumerDir} -D before=${before}
      -P ${PROJECT_SOURCE_DIR}/regression/consumer/macros.cmake)
  set_tests_properties(consumer.macros.${before} PROPERTIES FIXTURES_REQUIRED installed
    SKIP_REGULAR_EXPRESSION "skipped: ")
endforeach()
if(OPENSUBDIVHEX_TOOLS)
  add_test(NAME consumer.hexrefine
    COMMAND ${consumerDir}/prefix/${CMAKE_INSTALL_BINDIR}/hexrefine --help)
  set_tests_properties(consumer.hexrefine PROPERTIES FIXTURES_REQUIRED installed)
endif()

# Programs that use the libraries of devices.
set(libraries far_ext osd_ext bfr_ext)
set(programs "")
foreach(device IN ITEMS gl cuda)
  if(TARGET osd_ext_${device})
    list(APPEND libraries osd_ext_${device})
    list(APPEND programs consumer_${device})
  endif()
endforeach()
if(programs)
  list(JOIN libraries "," libraries)
  list(JOIN programs "," programs)
  add_test(NAME consumer.devices
    COMMAND ${CMAKE_COMMAND}
      -D sourceDir=${PROJECT_SOURCE_DIR}/regression/consumer/devices
      -D buildDir=${PROJECT_BINARY_DIR}
      -D workDir=${consumerDir}/devices
      -D config=$<CONFIG>
      -D libraries=${libraries}
      -D programs=${programs}
      -D options=-G${CMAKE_GENERATOR},-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER},-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS},-DOpenSubdiv_ROOT=${OpenSubdiv_ROOT}
      -P ${PROJECT_SOURCE_DIR}/regression/consumer/devices.cmake)
endif()

add_test(NAME consumer.examples
  COMMAND ${CMAKE_COMMAND} -D sourceDir=${PROJECT_SOURCE_DIR} -D opensubdivDir=${OpenSubdiv_INCLUDE_DIR}
    -P ${PROJECT_SOURCE_DIR}/regression/consumer/examples.cmake)
add_test(NAME consumer.versions
  COMMAND ${CMAKE_COMMAND} -D sourceDir=${PROJECT_SOURCE_DIR} -D version=${PROJECT_VERSION}
    -P ${PROJECT_SOURCE_DIR}/regression/consumer/versions.cmake)

# The recipe of the vcpkg port.
if(OPENSUBDIVHEX_TOOLS AND CMAKE_INSTALL_LIBDIR STREQUAL "lib")
  add_test(NAME consumer.port
    COMMAND ${CMAKE_COMMAND}
      -D sourceDir=${PROJECT_SOURCE_DIR}
      -D buildDir=${PROJECT_BINARY_DIR}
      -D workDir=${consumerDir}/port
      -D config=$<CONFIG>
      -D generator=${CMAKE_GENERATOR}
      -D compiler=${CMAKE_CXX_COMPILER}
      "-D options=-DCMAKE_PREFIX_PATH=${CMAKE_PREFIX_PATH}"
      -P ${PROJECT_SOURCE_DIR}/regression/consumer/port.cmake)
endif()

# What the shared libraries export, and that an OpenSubdiv outside the system's folders is found.
if(UNIX AND NOT APPLE)
  get_target_property(libraryType far_ext TYPE)
  if(libraryType STREQUAL "SHARED_LIBRARY")
    set(libraries far_ext osd_ext bfr_ext)
    set(publicNames 22TopologyRefinerFactory6Create 19RefinementEvaluator6Create
      14SurfaceFactory6Create)
    foreach(library publicName IN ZIP_LISTS libraries publicNames)
      add_test(NAME consumer.exports.${library}
        COMMAND ${CMAKE_COMMAND} -D nm=${CMAKE_NM} -D library=$<TARGET_FILE:${library}>
          -D public=${publicName} -P ${PROJECT_SOURCE_DIR}/regression/consumer/exports.cmake)
    endforeach()
  endif()
  add_test(NAME consumer.elsewhere
    COMMAND ${CMAKE_COMMAND}
      -D sourceDir=${PROJECT_SOURCE_DIR}/regression/consumer/elsewhere
      -D workDir=${consumerDir}/elsewhere
      -D library=$<TARGET_FILE:OpenSubdiv::osdCPU>
      -D includeDir=${OpenSubdiv_INCLUDE_DIR}
      -D compiler=${CMAKE_CXX_COMPILER}
      -D generator=${CMAKE_GENERATOR}
      -P ${PROJECT_SOURCE_DIR}/regression/consumer/elsewhere.cmake)
  set_tests_properties(consumer.elsewhere PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: ")
endif()
