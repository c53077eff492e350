# SPDX-License-Identifier: Apache-2.0
#
# Draws MESH twice with PROGRAM: with all patches kept, and with hardly any, which is told.  The picture
# is the same.  Vertices that no face shows leave it as it is.  Bad usage is refused, with a message that
# names the option.
function(draw memory result)
  set(file ${FOLDER}/stream${memory}.png)
  file(REMOVE ${file})
  execute_process(COMMAND ${PROGRAM} ${MESH} --output ${file} --width 40 --height 30 --samples 1
      --facet-pixels 0.3 --memory ${memory}
    OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE status)
  message("${memory} megabytes: ${output}${error}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "exit status ${status}")
  endif()
  string(REGEX MATCH "([0-9]+) of ([0-9]+) faces were needed, ([0-9]+) patches made, ([0-9]+) of them again, ([0-9]+) forgotten"
    line "${output}")
  if(NOT line OR NOT CMAKE_MATCH_1 GREATER 0)
    message(FATAL_ERROR "nothing was made")
  endif()
  set(made ${CMAKE_MATCH_3} PARENT_SCOPE)
  math(EXPR made "${CMAKE_MATCH_1} + ${CMAKE_MATCH_4}")
  if(NOT made EQUAL CMAKE_MATCH_3)
    message(FATAL_ERROR "patches are not counted")
  endif()
  set(forgotten ${CMAKE_MATCH_5} PARENT_SCOPE)
  string(REGEX MATCHALL "warning: patches are made again and again" warnings "${error}")
  list(LENGTH warnings numWarnings)
  set(numWarnings ${numWarnings} PARENT_SCOPE)
  file(SHA256 ${file} hash)
  set(${result} ${hash} PARENT_SCOPE)
endfunction()

draw(1000 all)
set(madeOnce ${made})
if(NOT forgotten EQUAL 0 OR NOT numWarnings EQUAL 0)
  message(FATAL_ERROR "there was memory for all")
endif()
draw(10 few)
if(NOT forgotten GREATER 0 OR NOT made GREATER madeOnce)
  message(FATAL_ERROR "nothing was forgotten")
endif()
if(NOT numWarnings EQUAL 1)
  message(FATAL_ERROR "${numWarnings} warnings that memory is short")
endif()
if(NOT all STREQUAL few)
  message(FATAL_ERROR "the pictures differ")
endif()

# The picture of MESH with TEXT behind it.
function(drawWith text result)
  set(file ${FOLDER}/streamShown)
  file(READ ${MESH} content)
  file(WRITE ${file}.obj "${content}${text}")
  file(REMOVE ${file}.png)
  execute_process(COMMAND ${PROGRAM} ${file}.obj --output ${file}.png --width 40 --height 30 --samples 1
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(SHA256 ${file}.png hash)
  set(${result} ${hash} PARENT_SCOPE)
endfunction()

drawWith("" alone)
drawWith("v 200 -9 0\nv 1e30 0 0\nv 0 1e30 0\nv 0 2 0\n" vertices)
file(STRINGS ${MESH} faces REGEX "^f ")
list(LENGTH faces numFaces)
drawWith("v 200 -9 0\nv 1e30 0 0\nv 0 1e30 0\nf -1 -2 -3\nt hole 1/0/0 ${numFaces}\n" hole)
if(NOT vertices STREQUAL alone OR NOT hole STREQUAL alone)
  message(FATAL_ERROR "vertices that no face shows change the picture")
endif()

function(refuse cause file)
  execute_process(COMMAND ${PROGRAM} ${MESH} --output ${file} --width 4 --height 3 --samples 1
      ${ARGN}
    OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE status)
  if(NOT status EQUAL 2 OR NOT error MATCHES "${cause}")
    message(FATAL_ERROR "${file} ${ARGN}: exit status ${status}, ${error}")
  endif()
endfunction()

refuse("--memory: 'nan'" none.png --memory nan)
refuse("--memory: " none.png --memory -1)
refuse("--facet-pixels: 'nan'" none.png --facet-pixels nan)
refuse("--camera: the zoom factor is not positive" none.png --camera 30,20,0)
refuse("--camera: the zoom factor is not positive" none.png --camera 30,20,-1)
refuse("--camera: 95 is not between -90 and 90 degrees" none.png --camera 30,95)
refuse("--output: 'none.jpg' is not a .png file" none.jpg)
