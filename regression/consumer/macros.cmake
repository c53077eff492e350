# SPDX-License-Identifier: Apache-2.0
#
# All public headers, those of libraries that were not built too, compile behind the macros of others:
# cmake -D sourceDir=DIR -D includeDir=DIR -D workDir=DIR -D compiler=PATH -D flags=LIST
#   -D missing=LIST -D before=hostile|xlib -P macros.cmake
#
# hostile: those of hostileMacros.h, which stand behind what our headers include of others.
# xlib: those of X11, which stand before it, as in a program that includes GL/glx.h first.
include(${CMAKE_CURRENT_LIST_DIR}/publicHeaders.cmake)
get_public_headers(headers)
remove_uncompilable(headers)

set(source ${workDir}/${before}.cpp)
set(ours "")
set(lines "")
foreach(header IN LISTS headers)
  string(APPEND ours "#include <${header}>\n")
  set(path ${includeDir}/${header})
  if(NOT EXISTS ${path})
    set(path ${sourceDir}/${header})
  endif()
  file(STRINGS ${path} includes REGEX "^ *# *include <")
  list(APPEND lines ${includes})
endforeach()
list(REMOVE_DUPLICATES lines)
set(theirs "")
foreach(line IN LISTS lines)
  string(REGEX MATCH "<.*>" name "${line}")
  string(APPEND theirs "#if __has_include(${name})\n${line}\n#endif\n")
endforeach()

if(before STREQUAL "hostile")
  file(WRITE ${source} "${theirs}\n#include \"${CMAKE_CURRENT_LIST_DIR}/hostileMacros.h\"\n${ours}")
else()
  set(xlib "#include <X11/Xlib.h>\n#include <X11/Xutil.h>\n")
  file(WRITE ${source} "${xlib}")
  execute_process(COMMAND ${compiler} ${flags} -fsyntax-only ${source} RESULT_VARIABLE result
    ERROR_QUIET)
  if(NOT result EQUAL 0)
    message("skipped: X11/Xlib.h and X11/Xutil.h are not there (Debian: libx11-dev)")
    return()
  endif()
  file(WRITE ${source} "${xlib}${ours}")
endif()
# Headers of libraries that were not built are not installed.
compile(${source} "the public headers behind the macros of ${before}" -Werror -I${includeDir}
  -I${sourceDir})
