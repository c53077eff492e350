# SPDX-License-Identifier: Apache-2.0
#
# cmake -D buildDir=... -D sourceDir=... -D prefix=... -D config=... -P install.cmake
#
# Installs buildDir, moves the result to prefix, and checks that the package files name no folder of
# this machine.
file(REMOVE_RECURSE ${prefix} ${prefix}.first)
execute_process(
  COMMAND ${CMAKE_COMMAND} --install ${buildDir} --prefix ${prefix}.first --config ${config}
  COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${prefix}.first ${prefix})

file(GLOB_RECURSE packageFiles ${prefix}/*.cmake ${prefix}/*.pc)
if(NOT packageFiles)
  message(SEND_ERROR "no package files in ${prefix}")
endif()
foreach(packageFile IN LISTS packageFiles)
  file(READ ${packageFile} content)
  foreach(dir IN ITEMS ${sourceDir} ${buildDir} ${prefix})
    string(FIND "${content}" "${dir}" position)
    if(NOT position EQUAL -1)
      message(SEND_ERROR "${packageFile} names ${dir}")
    endif()
  endforeach()
endforeach()
