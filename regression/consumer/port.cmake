# SPDX-License-Identifier: Apache-2.0
#
# cmake -D sourceDir=... -D buildDir=... -D workDir=... -D config=... -D generator=...
#       -D compiler=... -D "options=..." -P port.cmake
#
# Reads the recipe of the vcpkg port with stand-ins for vcpkg's functions: the project is configured
# with the recipe's options, of which it has to know all, but what is installed is buildDir, which is
# built already.  Checks that all is where the recipe looks.
cmake_minimum_required(VERSION 3.24)

file(READ ${sourceDir}/ports/opensubdivhex/vcpkg.json manifest)

file(REMOVE_RECURSE ${workDir})
set(CURRENT_PACKAGES_DIR ${workDir}/package)
set(FEATURES tools)
set(called "")

# Pairs of a feature and its option.
function(vcpkg_check_features)
  cmake_parse_arguments(arg "" OUT_FEATURE_OPTIONS FEATURES ${ARGN})
  set(result "")
  while(arg_FEATURES)
    list(POP_FRONT arg_FEATURES feature option)
    string(JSON found ERROR_VARIABLE error GET "${manifest}" features ${feature})
    if(error)
      message(FATAL_ERROR "the manifest has no feature ${feature}")
    endif()
    set(isOn OFF)
    if(feature IN_LIST FEATURES)
      set(isOn ON)
    endif()
    list(APPEND result -D${option}=${isOn})
  endwhile()
  set(${arg_OUT_FEATURE_OPTIONS} ${result} PARENT_SCOPE)
endfunction()

function(vcpkg_cmake_configure)
  cmake_parse_arguments(arg "" SOURCE_PATH OPTIONS ${ARGN})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${arg_SOURCE_PATH} -B ${workDir}/build -G ${generator}
      -DCMAKE_CXX_COMPILER=${compiler} ${options} ${arg_OPTIONS}
    ERROR_VARIABLE errors COMMAND_ERROR_IS_FATAL ANY)
  if(errors MATCHES "Manually-specified variables were not used")
    message(FATAL_ERROR "the recipe has options that the project has not:\n${errors}")
  endif()
endfunction()

function(vcpkg_cmake_install)
  execute_process(
    COMMAND ${CMAKE_COMMAND} --install ${buildDir} --prefix ${CURRENT_PACKAGES_DIR}
      --config ${config}
    COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(expectFile pattern)
  file(GLOB found ${CURRENT_PACKAGES_DIR}/${pattern})
  if(NOT found)
    message(FATAL_ERROR "the recipe looks for ${pattern}, which is not installed")
  endif()
endfunction()

function(vcpkg_cmake_config_fixup)
  cmake_parse_arguments(arg "" "PACKAGE_NAME;CONFIG_PATH" "" ${ARGN})
  expectFile(${arg_CONFIG_PATH}/${arg_PACKAGE_NAME}Config.cmake)
endfunction()

function(vcpkg_fixup_pkgconfig)
  expectFile(lib/pkgconfig/*.pc)
endfunction()

function(vcpkg_copy_tools)
  cmake_parse_arguments(arg AUTO_CLEAN "" TOOL_NAMES ${ARGN})
  foreach(tool IN LISTS arg_TOOL_NAMES)
    expectFile(bin/${tool}*)
  endforeach()
endfunction()

function(vcpkg_install_copyright)
  cmake_parse_arguments(arg "" "" FILE_LIST ${ARGN})
  foreach(file IN LISTS arg_FILE_LIST)
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "no licence in ${file}")
    endif()
  endforeach()
  set(isDone TRUE PARENT_SCOPE)
endfunction()

include(${sourceDir}/ports/opensubdivhex/portfile.cmake)
if(NOT isDone)
  message(FATAL_ERROR "the recipe installs no licence")
endif()
