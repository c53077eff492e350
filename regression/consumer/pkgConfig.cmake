# SPDX-License-Identifier: Apache-2.0
#
# cmake -D pkgConfig=... -D prefix=... -D libDir=... -D version=... -D compiler=... -D flags=LIST
#       -D source=... -D program=... -P pkgConfig.cmake
#
# Compiles a program with nothing but what pkg-config says of the tree that is installed in prefix,
# and runs it.
set(ENV{PKG_CONFIG_PATH} ${prefix}/${libDir}/pkgconfig)
execute_process(COMMAND ${pkgConfig} --modversion opensubdivhex
  OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(NOT found STREQUAL version)
  message(FATAL_ERROR "pkg-config has version ${found} for ${version}")
endif()
execute_process(COMMAND ${pkgConfig} --cflags --libs opensubdivhex
  OUTPUT_VARIABLE arguments OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
message("pkg-config: ${arguments}")
separate_arguments(arguments UNIX_COMMAND "${arguments}")
execute_process(
  COMMAND ${compiler} -std=c++17 ${flags} -DPACKAGE_VERSION="${version}" ${source} -o ${program}
    ${arguments} -Wl,-rpath,${prefix}/${libDir}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${program} COMMAND_ERROR_IS_FATAL ANY)
