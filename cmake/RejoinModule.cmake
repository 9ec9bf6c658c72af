# rejoin_module(NAME SOURCES ... [ALONE ...] [PUBLIC ...] [PRIVATE ...])
#   A static library rejoin_NAME, alias rejoin::NAME, with the project's warnings and number rules.  ALONE are sources that others cannot be compiled
#   with as one (CMAKE_UNITY_BUILD): kernels that include themselves for each processor, headers with macros.
# rejoin_test(NAME SOURCES ... LIBS ... [LABELS ...] [TOGETHER])
#   A GoogleTest program; each TEST becomes a CTest entry, or the program as a whole if they are run TOGETHER, as what they share takes
#   longer to make than most of them run (with REJOIN_FAST_TESTS each fast program is one).  LABELS default to "fast".

add_library(rejoin_warnings INTERFACE)
target_compile_options(rejoin_warnings INTERFACE -Wall -Wextra -Wpedantic -ffp-contract=off
                       $<$<BOOL:${REJOIN_WERROR}>:-Werror>)

function(rejoin_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;PUBLIC;PRIVATE" ${ARGN})
  add_library(rejoin_${name} STATIC ${ARG_SOURCES} ${ARG_ALONE})
  add_library(rejoin::${name} ALIAS rejoin_${name})
  target_include_directories(rejoin_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(rejoin_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} rejoin_warnings)
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

function(rejoin_test name)
  cmake_parse_arguments(ARG "TOGETHER" "" "SOURCES;LIBS;LABELS" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS fast)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest GTest::gtest_main rejoin_warnings)
  target_compile_definitions(${name} PRIVATE REJOIN_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  separate_arguments(flags UNIX_COMMAND "${REJOIN_PLAIN_FLAGS}")
  target_compile_options(${name} PRIVATE ${flags})
  if(REJOIN_FAST_TESTS AND "fast" IN_LIST ARG_LABELS)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 1800)
  elseif(REJOIN_FAST_TESTS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  elseif(ARG_TOGETHER)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 1800 COST 1000)  # the longest first
  else()
    gtest_discover_tests(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600 DISCOVERY_TIMEOUT 120)
  endif()
endfunction()
