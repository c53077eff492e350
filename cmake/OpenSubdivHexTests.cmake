# SPDX-License-Identifier: Apache-2.0

find_package(GTest REQUIRED)
include(GoogleTest)

# opensubdivhex_add_tests(NAME SOURCES... LIBRARIES... [RESEARCH FILTER] [LONG FILTER]): a test program, each
# test of which is one of CTest's, NAME.Suite.Test.  Those that GoogleTest's filter of RESEARCH names have the
# label research and run in ./dev research alone; those of LONG, which take more than some three seconds with
# sanitizers, have the label long and are left out by ./dev sanitize short.  Compiling tests takes longer than
# running them: so they are optimized little, which takes a quarter less, and what they test as ever.
function(opensubdivhex_add_tests name)
  cmake_parse_arguments(arg "" "RESEARCH;LONG" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  target_compile_options(${name} PRIVATE
    $<$<AND:$<CONFIG:Release>,$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>>:-O1>)
  set(labelled "")
  foreach(label IN ITEMS research long)
    string(TOUPPER ${label} keyword)
    if(arg_${keyword})
      # Tests of a cost begin before others: who begins a long one at the end waits for it alone.
      gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${name}.
        TEST_FILTER ${arg_${keyword}} PROPERTIES LABELS ${label} COST 1)
      list(APPEND labelled ${arg_${keyword}})
    endif()
  endforeach()
  if(labelled)
    list(JOIN labelled ":" labelled)
    set(others TEST_FILTER "-${labelled}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${name}. ${others})
endfunction()
