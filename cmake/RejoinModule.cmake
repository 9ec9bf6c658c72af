# rejoin_module(NAME SOURCES ... [PUBLIC ...] [PRIVATE ...])
#   A static library rejoin_NAME, alias rejoin::NAME, with the project's warnings and number rules.
# rejoin_test(NAME SOURCES ... LIBS ... [LABELS ...])
#   A GoogleTest program; each TEST becomes a CTest entry.  LABELS default to "fast".

add_library(rejoin_warnings INTERFACE)
target_compile_options(rejoin_warnings INTERFACE -Wall -Wextra -Wpedantic -ffp-contract=off
                       $<$<BOOL:${REJOIN_WERROR}>:-Werror>)

function(rejoin_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(rejoin_${name} STATIC ${ARG_SOURCES})
  add_library(rejoin::${name} ALIAS rejoin_${name})
  target_include_directories(rejoin_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(rejoin_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} rejoin_warnings)
endfunction()

function(rejoin_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS fast)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest GTest::gtest_main rejoin_warnings)
  target_compile_definitions(${name} PRIVATE REJOIN_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  gtest_discover_tests(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600 DISCOVERY_TIMEOUT 120)
endfunction()
