# SPDX-License-Identifier: Apache-2.0
#
# Runs PROGRAM with the race of KIND, which ThreadSanitizer must find and fail it for.
execute_process(COMMAND ${PROGRAM} ${KIND} OUTPUT_VARIABLE output ERROR_VARIABLE output
  RESULT_VARIABLE status)
if(status EQUAL 0 OR NOT output MATCHES "ThreadSanitizer: data race")
  message(FATAL_ERROR "no race was found, exit status ${status}: ${output}")
endif()
