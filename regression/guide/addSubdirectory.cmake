# SPDX-License-Identifier: Apache-2.0
#
# cmake -D sourceDir=DIR -D guideDir=DIR -D binaryDir=DIR -D compiler=PATH -P addSubdirectory.cmake
#
# Configures the project that the cookbook shows under "add_subdirectory", with the clone sourceDir in it,
# and compiles the guide's first program in that project, as it stands on the page.  The libraries, which
# are built elsewhere, are not built again.
cmake_minimum_required(VERSION 3.24)

# The first block of a language behind a heading of a page.
function(get_block page heading language result)
  file(READ ${page} text)
  string(FIND "${text}" "\n${heading}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${page} has no heading ${heading}")
  endif()
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```${language}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${page} shows no ${language} below ${heading}")
  endif()
  string(LENGTH "\n```${language}\n" length)
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  set(${result} "${text}\n" PARENT_SCOPE)
endfunction()

get_block(${guideDir}/cookbook.md "## add_subdirectory" cmake project)
get_block(${guideDir}/renderer.md "## A first program" cpp program)

file(REMOVE_RECURSE ${binaryDir})
file(MAKE_DIRECTORY ${binaryDir}/external)
file(CREATE_LINK ${sourceDir} ${binaryDir}/external/OpenSubdivHex SYMBOLIC)
file(WRITE ${binaryDir}/CMakeLists.txt "${project}")
file(WRITE ${binaryDir}/renderer.cpp "${program}")
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${binaryDir} -B ${binaryDir}/build
    -D CMAKE_CXX_COMPILER=${compiler}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${binaryDir}/build
    --target CMakeFiles/renderer.dir/renderer.cpp.o
  COMMAND_ERROR_IS_FATAL ANY)
