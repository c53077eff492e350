# SPDX-License-Identifier: Apache-2.0
#
# Runs PROGRAM, a list with its arguments, which must succeed and print EXPECTED.  (CTest's
# PASS_REGULAR_EXPRESSION would leave the exit status out.)
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE output ERROR_VARIABLE output
  RESULT_VARIABLE status)
message("${output}")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "exit status ${status}")
endif()
string(FIND "${output}" "${EXPECTED}" position)
if(position EQUAL -1)
  message(FATAL_ERROR "did not print: ${EXPECTED}")
endif()
