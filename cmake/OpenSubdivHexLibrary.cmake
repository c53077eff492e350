# SPDX-License-Identifier: Apache-2.0

# A new major version may change what is there.  Shared libraries are named after it, and the
# package's version files tell by it.
set(OPENSUBDIVHEX_SOVERSION ${PROJECT_VERSION_MAJOR})
set(OPENSUBDIVHEX_COMPATIBILITY SameMajorVersion)

# opensubdivhex_add_library(NAME SOURCES...): a library of this project, OpenSubdivHex::NAME to all
# who link it, installed with the headers at the top of its folder; those in subfolders are its own.
# Users include <NAME/header.h>.
function(opensubdivhex_add_library name)
  add_library(${name} ${ARGN})
  add_library(OpenSubdivHex::${name} ALIAS ${name})
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME opensubdivhex_${name}
    VERSION ${PROJECT_VERSION}
    SOVERSION ${OPENSUBDIVHEX_SOVERSION}
    POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    WINDOWS_EXPORT_ALL_SYMBOLS ON)
  target_compile_features(${name} PUBLIC cxx_std_17)
  # For export.h.
  target_compile_definitions(${name} PRIVATE
    $<$<STREQUAL:$<TARGET_PROPERTY:${name},TYPE>,SHARED_LIBRARY>:OPENSUBDIVHEX_IS_SHARED>)

  set(headers ${ARGN})
  list(FILTER headers INCLUDE REGEX "^[^/]*\\.h$")
  target_sources(${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})

  # The file set puts the project's root on the include path; installed, it is DESTINATION.
  if(OPENSUBDIVHEX_INSTALL)
    install(TARGETS ${name} EXPORT OpenSubdivHexTargets
      RUNTIME COMPONENT library
      LIBRARY COMPONENT library NAMELINK_COMPONENT development
      ARCHIVE COMPONENT development
      FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/opensubdivhex COMPONENT development)
  endif()
endfunction()

# opensubdivhex_link_objects(TARGET LIBRARY...): links all of the libraries, what shared ones do not
# export too: for tests of that.
function(opensubdivhex_link_objects target)
  foreach(library IN LISTS ARGN)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${library}>)
    target_include_directories(${target} PRIVATE
      $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
    target_link_libraries(${target} PRIVATE $<TARGET_PROPERTY:${library},LINK_LIBRARIES>)
  endforeach()
endfunction()

# Gives OpenMP to a library that uses it, unless it is switched off or not there.
function(opensubdivhex_link_openmp name)
  if(TARGET OpenMP::OpenMP_CXX)
    target_link_libraries(${name} PRIVATE OpenMP::OpenMP_CXX)
    get_target_property(type ${name} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
      set_property(GLOBAL PROPERTY OPENSUBDIVHEX_NEEDS_OPENMP TRUE)
    endif()
  endif()
endfunction()
