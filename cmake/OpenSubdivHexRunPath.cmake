# SPDX-License-Identifier: Apache-2.0

# Where installed programs and libraries look for shared libraries: in their own tree, wherever that
# is moved, and where those lie that they were linked with, outside the system's folders too.
if(NOT DEFINED CMAKE_INSTALL_RPATH AND UNIX AND NOT APPLE)
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_FULL_BINDIR}
    OUTPUT_VARIABLE libraryDir)
  set(CMAKE_INSTALL_RPATH $ORIGIN $ORIGIN/${libraryDir})
endif()
if(NOT DEFINED CMAKE_INSTALL_RPATH_USE_LINK_PATH)
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
endif()
