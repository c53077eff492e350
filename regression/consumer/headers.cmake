# SPDX-License-Identifier: Apache-2.0
#
# The installed headers are those at the top of the layers' folders, no internal ones and none that
# begin with one of notBuilt, whose libraries were not built.  Each compiles alone, and a program that
# uses their templates does, without a warning of those that strict users switch on:
# cmake -D sourceDir=DIR -D includeDir=DIR -D compiler=PATH -D flags=LIST -D missing=LIST
#   -D notBuilt=LIST -P headers.cmake
include(${CMAKE_CURRENT_LIST_DIR}/publicHeaders.cmake)
get_public_headers(expected)
foreach(begin IN LISTS notBuilt)
  list(FILTER expected EXCLUDE REGEX "^${begin}[A-Z]")
endforeach()
file(GLOB_RECURSE installed RELATIVE ${includeDir} ${includeDir}/*.h)
list(SORT installed)
list(JOIN installed "\n  " shown)
message("installed headers:\n  ${shown}")
if(NOT installed STREQUAL expected)
  list(JOIN expected "\n  " shown)
  message(FATAL_ERROR "expected were:\n  ${shown}")
endif()

# Those that GCC and Clang both know.
set(strict -Wall -Wextra -Wpedantic -Werror -Wcast-align -Wcast-qual -Wconversion
  -Wdouble-promotion -Wextra-semi -Wformat=2 -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wredundant-decls -Wshadow -Wsign-conversion -Wswitch-enum -Wundef
  -Wzero-as-null-pointer-constant)
remove_uncompilable(installed)
foreach(header IN LISTS installed)
  file(WRITE ${includeDir}/../alone.cpp "#include <${header}>\nint main() {}\n")
  compile(${includeDir}/../alone.cpp "${header} alone" ${strict} -I${includeDir})
endforeach()
compile(${CMAKE_CURRENT_LIST_DIR}/templates.cpp "a program that uses templates" ${strict}
  -I${includeDir})
