# SPDX-License-Identifier: Apache-2.0
#
# The installed headers are those at the top of the layers' folders, no internal ones and none that
# begin with one of notBuilt, whose libraries were not built.  Each compiles alone, but for those whose
# names begin with one of missing, which need what is not there:
# cmake -D sourceDir=DIR -D includeDir=DIR -D compiler=PATH -D flags=LIST -D missing=LIST
#   -D notBuilt=LIST -P headers.cmake
file(GLOB expected RELATIVE ${sourceDir} ${sourceDir}/far_ext/*.h ${sourceDir}/osd_ext/*.h
  ${sourceDir}/bfr_ext/*.h)
list(APPEND expected far_ext/version.h)
foreach(begin IN LISTS notBuilt)
  list(FILTER expected EXCLUDE REGEX "^${begin}[A-Z]")
endforeach()
list(SORT expected)
file(GLOB_RECURSE installed RELATIVE ${includeDir} ${includeDir}/*.h)
list(SORT installed)
list(JOIN installed "\n  " shown)
message("installed headers:\n  ${shown}")
if(NOT installed STREQUAL expected)
  list(JOIN expected "\n  " shown)
  message(FATAL_ERROR "expected were:\n  ${shown}")
endif()

foreach(begin IN LISTS missing)
  list(FILTER installed EXCLUDE REGEX "/${begin}[A-Z]")
endforeach()
foreach(header IN LISTS installed)
  file(WRITE ${includeDir}/../alone.cpp "#include <${header}>\nint main() {}\n")
  execute_process(
    COMMAND ${compiler} -std=c++17 -fsyntax-only -Wall -Wextra -Werror ${flags} -I${includeDir}
      ${includeDir}/../alone.cpp
    RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${header} does not compile alone")
  endif()
endforeach()
