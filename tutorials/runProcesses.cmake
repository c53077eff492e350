# SPDX-License-Identifier: Apache-2.0
#
# Runs PROGRAM with 1, 2 and 4 ranks of MPI, by MPIEXEC: all write the same file in FOLDER.
execute_process(COMMAND ${MPIEXEC} --version OUTPUT_VARIABLE version ERROR_VARIABLE version)
set(options)
if(version MATCHES "Open ?MPI|OpenRTE")
  # As many ranks as are wanted, as anybody, and none tied to a processor.
  set(options --allow-run-as-root --oversubscribe --bind-to none)
endif()
foreach(numRanks IN ITEMS 1 2 4)
  set(file ${FOLDER}/processes${numRanks}.ply)
  file(REMOVE ${file})
  execute_process(COMMAND ${MPIEXEC} -n ${numRanks} ${options} ${PROGRAM} ${file} 5
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
  message("${numRanks} ranks: ${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "exit status ${status}")
  endif()
  string(FIND "${output}" "5160 points, 10316 triangles" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "other points and triangles")
  endif()
  file(SHA256 ${file} hash)
  if(numRanks EQUAL 1)
    set(expected ${hash})
  elseif(NOT hash STREQUAL expected)
    message(FATAL_ERROR "${file} differs from that of one rank")
  endif()
endforeach()
