# SPDX-License-Identifier: Apache-2.0
#
# cmake -D sourceDir=... -D workDir=... -D library=... -D includeDir=... [-D compiler=...]
#       [-D generator=...] -P elsewhere.cmake
#
# Copies OpenSubdiv's library and headers to a prefix of their own, outside the system's folders, and
# checks that an installed program loads them from there.
file(REMOVE_RECURSE ${workDir})
file(REAL_PATH ${workDir} workDir)
set(prefix ${workDir}/opensubdiv)
cmake_path(GET library PARENT_PATH libraryDir)
file(GLOB libraries ${libraryDir}/libosdCPU.so*)
if(NOT libraries)
  message("skipped: OpenSubdiv is static, there is nothing to load")
  return()
endif()
file(COPY ${libraries} DESTINATION ${prefix}/lib)
file(COPY ${includeDir}/opensubdiv DESTINATION ${prefix}/include)

foreach(command IN ITEMS
    "-S;${sourceDir};-B;${workDir}/build;-G;${generator};-DCMAKE_CXX_COMPILER=${compiler};-DOpenSubdiv_ROOT=${prefix}"
    "--build;${workDir}/build"
    "--install;${workDir}/build;--prefix;${workDir}/installed")
  execute_process(COMMAND ${CMAKE_COMMAND} ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=LD_LIBRARY_PATH
    ${workDir}/installed/bin/elsewhere
  OUTPUT_VARIABLE loaded OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
cmake_path(IS_PREFIX prefix "${loaded}" isFound)
if(NOT isFound)
  message(FATAL_ERROR "an installed program loads ${loaded}, not that in ${prefix}")
endif()
