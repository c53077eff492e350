# SPDX-License-Identifier: Apache-2.0

find_package(GTest REQUIRED)
include(GoogleTest)

# opensubdivhex_add_tests(NAME SOURCES... LIBRARIES... [RESEARCH FILTER]): a test program, each test of
# which is one of CTest's, NAME.Suite.Test; those that GoogleTest's filter names have the label research and
# run in ./dev research alone.  Compiling tests takes longer than running them: so they are optimized
# little, which takes a quarter less, and what they test as ever.
function(opensubdivhex_add_tests name)
  cmake_parse_arguments(arg "" "RESEARCH" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  target_compile_options(${name} PRIVATE
    $<$<AND:$<CONFIG:Release>,$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>>:-O1>)
  if(arg_RESEARCH)
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${name}. TEST_FILTER ${arg_RESEARCH}
      PROPERTIES LABELS research)
    set(others TEST_FILTER "-${arg_RESEARCH}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${name}. ${others})
endfunction()
