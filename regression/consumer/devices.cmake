# SPDX-License-Identifier: Apache-2.0
#
# cmake -D sourceDir=... -D buildDir=... -D workDir=... -D config=... -D libraries=NAME,...
#       -D programs=NAME,... -D options=OPTION,... -P devices.cmake
#
# Installs the libraries of buildDir to a prefix of their own, and builds and runs programs that use
# those of devices.
foreach(list IN ITEMS libraries programs options)
  string(REPLACE "," ";" ${list} "${${list}}")
endforeach()
file(REMOVE_RECURSE ${workDir})
foreach(command IN ITEMS
    "--build;${buildDir};--config;${config};--target;${libraries}"
    "--install;${buildDir};--prefix;${workDir}/prefix;--config;${config};--component;library"
    "--install;${buildDir};--prefix;${workDir}/prefix;--config;${config};--component;development"
    "-S;${sourceDir};-B;${workDir}/build;-DCMAKE_PREFIX_PATH=${workDir}/prefix;-DCMAKE_BUILD_TYPE=${config};${options}"
    "--build;${workDir}/build;--config;${config}")
  execute_process(COMMAND ${CMAKE_COMMAND} ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
foreach(program IN LISTS programs)
  execute_process(COMMAND ${workDir}/build/${program} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
