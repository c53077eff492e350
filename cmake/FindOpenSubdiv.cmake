# SPDX-License-Identifier: Apache-2.0
#
# FindOpenSubdiv: OpenSubdiv, with or without a CMake package of its own.
#
# Targets (always these names):
#   OpenSubdiv::osdCPU    the CPU library, shared or static
#   OpenSubdiv::osdGPU    the GPU library, when there is one
# Both carry OPENSUBDIV_HAS_OPENMP when the library has Osd::OmpEvaluator.
# Variables: OpenSubdiv_FOUND, OpenSubdiv_VERSION, OpenSubdiv_INCLUDE_DIR.
# Where to look: OpenSubdiv_ROOT (CMake or environment), OpenSubdiv_DIR, CMAKE_PREFIX_PATH.
#
# OpenSubdiv's own package is preferred, but Debian's cannot be loaded: its targets name static
# libraries that are not shipped, and loading it is a fatal error.  So packages are only loaded once
# the files they name were seen; otherwise the header and the libraries are looked up.

# The packages that find_package would consider, without loading one: none is of version 0.0.0.
# List in `out`, best first.
function(_opensubdiv_list_configs out)
  set(userDir "${OpenSubdiv_DIR}")
  find_package(OpenSubdiv 0.0.0 EXACT CONFIG QUIET)
  set(configs ${OpenSubdiv_CONSIDERED_CONFIGS})
  if(userDir)
    set(OpenSubdiv_DIR "${userDir}" CACHE PATH "Folder of OpenSubdivConfig.cmake" FORCE)
    list(PREPEND configs "${userDir}/OpenSubdivConfig.cmake")
  else()
    unset(OpenSubdiv_DIR CACHE)
  endif()
  # Who names a root wants the library below it.
  set(root "${OpenSubdiv_ROOT}")
  if(NOT root)
    set(root "$ENV{OpenSubdiv_ROOT}")
  endif()
  if(root AND NOT userDir)
    file(REAL_PATH "${root}" root)
    foreach(config IN LISTS configs)
      file(REAL_PATH "${config}" path)
      cmake_path(IS_PREFIX root "${path}" isBelow)
      if(NOT isBelow)
        list(REMOVE_ITEM configs "${config}")
      endif()
    endforeach()
  endif()
  list(REMOVE_DUPLICATES configs)
  set(${out} "${configs}" PARENT_SCOPE)
endfunction()

# Whether all library files that the package of `config` names are there.  They are given relative
# to the prefix, which is one of the folders above the package's.
function(_opensubdiv_is_whole config out)
  cmake_path(GET config PARENT_PATH dir)
  set(${out} FALSE PARENT_SCOPE)
  file(GLOB targetFiles "${dir}/*[Tt]argets-*.cmake")
  set(files "")
  foreach(targetFile IN LISTS targetFiles)
    file(STRINGS "${targetFile}" lines REGEX "IMPORTED_(LOCATION|IMPLIB)")
    foreach(line IN LISTS lines)
      if(line MATCHES "\"(.*)\"")
        list(APPEND files "${CMAKE_MATCH_1}")
      endif()
    endforeach()
  endforeach()
  if(NOT files)
    return()
  endif()
  set(prefix "${dir}")
  while(TRUE)
    set(isWhole TRUE)
    foreach(file IN LISTS files)
      string(REPLACE "\${_IMPORT_PREFIX}" "${prefix}" path "${file}")
      if(NOT EXISTS "${path}")
        set(isWhole FALSE)
        break()
      endif()
    endforeach()
    if(isWhole)
      set(${out} TRUE PARENT_SCOPE)
      return()
    endif()
    cmake_path(GET prefix PARENT_PATH parent)
    if(parent STREQUAL prefix)
      return()
    endif()
    set(prefix "${parent}")
  endwhile()
endfunction()

# An imported target around a library file, static or shared.
function(_opensubdiv_add_library name file)
  add_library(OpenSubdiv::${name} UNKNOWN IMPORTED)
  set_target_properties(OpenSubdiv::${name} PROPERTIES
    IMPORTED_LOCATION "${file}"
    INTERFACE_INCLUDE_DIRECTORIES "${OpenSubdiv_INCLUDE_DIR}")
  if(EXISTS "${OpenSubdiv_INCLUDE_DIR}/opensubdiv/osd/ompEvaluator.h")
    set_property(TARGET OpenSubdiv::${name} APPEND PROPERTY
      INTERFACE_COMPILE_DEFINITIONS OPENSUBDIV_HAS_OPENMP)
    # A shared library brings its OpenMP along.
    if(file MATCHES "\\.(a|lib)$")
      find_package(OpenMP QUIET COMPONENTS CXX)
      if(TARGET OpenMP::OpenMP_CXX)
        set_property(TARGET OpenSubdiv::${name} APPEND PROPERTY
          INTERFACE_LINK_LIBRARIES OpenMP::OpenMP_CXX)
      endif()
    endif()
  endif()
endfunction()

# The project may have loaded OpenSubdiv before, or bring it along.
if(NOT TARGET OpenSubdiv::osdCPU AND NOT TARGET OpenSubdiv::osdCPU_static)
  set(_opensubdiv_version ${OpenSubdiv_FIND_VERSION})
  if(OpenSubdiv_FIND_VERSION_EXACT)
    list(APPEND _opensubdiv_version EXACT)
  endif()
  _opensubdiv_list_configs(_opensubdiv_configs)
  foreach(_opensubdiv_config IN LISTS _opensubdiv_configs)
    _opensubdiv_is_whole("${_opensubdiv_config}" _opensubdiv_whole)
    if(_opensubdiv_whole)
      cmake_path(GET _opensubdiv_config PARENT_PATH _opensubdiv_dir)
      find_package(OpenSubdiv ${_opensubdiv_version} CONFIG QUIET
        PATHS "${_opensubdiv_dir}" NO_DEFAULT_PATH)
      if(TARGET OpenSubdiv::osdCPU OR TARGET OpenSubdiv::osdCPU_static)
        break()
      endif()
    endif()
  endforeach()
endif()

# One name each, whatever the package calls it.
foreach(_opensubdiv_name IN ITEMS osdCPU osdGPU)
  if(NOT TARGET OpenSubdiv::${_opensubdiv_name} AND TARGET OpenSubdiv::${_opensubdiv_name}_static)
    add_library(OpenSubdiv::${_opensubdiv_name} ALIAS OpenSubdiv::${_opensubdiv_name}_static)
  endif()
endforeach()

if(TARGET OpenSubdiv::osdCPU)
  # A package sets OpenSubdiv_INCLUDE_DIR.
  get_target_property(_opensubdiv_dirs OpenSubdiv::osdCPU INTERFACE_INCLUDE_DIRECTORIES)
  find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/version.h HINTS ${_opensubdiv_dirs})
  set(_opensubdiv_required OpenSubdiv_INCLUDE_DIR)
else()
  find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/version.h)
  find_library(OpenSubdiv_osdCPU_LIBRARY osdCPU)
  # Of the same installation, or none.
  cmake_path(GET OpenSubdiv_osdCPU_LIBRARY PARENT_PATH _opensubdiv_dir)
  find_library(OpenSubdiv_osdGPU_LIBRARY osdGPU PATHS "${_opensubdiv_dir}" NO_DEFAULT_PATH)
  mark_as_advanced(OpenSubdiv_osdCPU_LIBRARY OpenSubdiv_osdGPU_LIBRARY)
  set(_opensubdiv_required OpenSubdiv_osdCPU_LIBRARY OpenSubdiv_INCLUDE_DIR)
endif()
mark_as_advanced(OpenSubdiv_INCLUDE_DIR)

set(OpenSubdiv_VERSION "")
if(OpenSubdiv_INCLUDE_DIR)
  file(STRINGS "${OpenSubdiv_INCLUDE_DIR}/opensubdiv/version.h" _opensubdiv_line
    REGEX "define +OPENSUBDIV_VERSION +v[0-9]+_[0-9]+_[0-9]+")
  if(_opensubdiv_line MATCHES "v([0-9]+)_([0-9]+)_([0-9]+)")
    set(OpenSubdiv_VERSION "${CMAKE_MATCH_1}.${CMAKE_MATCH_2}.${CMAKE_MATCH_3}")
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv
  REQUIRED_VARS ${_opensubdiv_required}
  VERSION_VAR OpenSubdiv_VERSION
  REASON_FAILURE_MESSAGE
    "install the package libosd-dev (Debian, Ubuntu), or point OpenSubdiv_ROOT at the prefix that OpenSubdiv is installed in")

if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
  _opensubdiv_add_library(osdCPU "${OpenSubdiv_osdCPU_LIBRARY}")
  if(OpenSubdiv_osdGPU_LIBRARY)
    _opensubdiv_add_library(osdGPU "${OpenSubdiv_osdGPU_LIBRARY}")
    set_property(TARGET OpenSubdiv::osdGPU APPEND PROPERTY
      INTERFACE_LINK_LIBRARIES OpenSubdiv::osdCPU ${CMAKE_DL_LIBS})
  endif()
endif()

unset(_opensubdiv_configs)
unset(_opensubdiv_config)
unset(_opensubdiv_dir)
unset(_opensubdiv_dirs)
unset(_opensubdiv_line)
unset(_opensubdiv_name)
unset(_opensubdiv_required)
unset(_opensubdiv_version)
unset(_opensubdiv_whole)
