# SPDX-License-Identifier: Apache-2.0
#
# For scripts that get sourceDir, compiler and flags, and missing, what the names of headers begin with
# that need what is not there.

# get_public_headers(OUT): those of all libraries, relative to the folder for users to include them from.
function(get_public_headers out)
  file(GLOB headers RELATIVE ${sourceDir} ${sourceDir}/far_ext/*.h ${sourceDir}/osd_ext/*.h
    ${sourceDir}/bfr_ext/*.h)
  list(APPEND headers far_ext/version.h)
  list(SORT headers)
  set(${out} ${headers} PARENT_SCOPE)
endfunction()

# remove_uncompilable(NAME): leaves out of the list of this name what needs what is not there.
function(remove_uncompilable name)
  set(list ${${name}})
  foreach(begin IN LISTS missing)
    list(FILTER list EXCLUDE REGEX "/${begin}[A-Z]")
  endforeach()
  set(${name} ${list} PARENT_SCOPE)
endfunction()

# compile(SOURCE WHAT [FLAG...]): fails with WHAT where the source does not compile.
function(compile source what)
  execute_process(COMMAND ${compiler} -std=c++17 -fsyntax-only ${flags} ${ARGN} ${source}
    RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} does not compile")
  endif()
endfunction()
