# What all targets share: warnings, optimisation, include root.

function(slipstick_configure target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion
    $<$<BOOL:${SLIPSTICK_WERROR}>:-Werror> $<$<BOOL:${SLIPSTICK_NATIVE}>:-march=native>)
endfunction()

# For tests, commands and what compares, whose work is done in the two wings: -O3 takes them half as long again to compile.
function(slipstick_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# slipstick_library(<folder> SOURCES ... PUBLIC <libraries> PRIVATE <libraries>)
function(slipstick_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target slipstick_${folder})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(slipstick::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/slipstick>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  slipstick_configure(${target})
endfunction()

# Seconds after which a test hangs: a machine may have other work, so at least twenty times what the slowest, that of the
# mutants, takes alone.
set(SLIPSTICK_TEST_HANGS 3600)

# slipstick_tests(<name> SOURCES ... LIBRARIES ...): one GoogleTest program, each case a test of its own in CTest; or,
# with SLIPSTICK_TEST_SHARDS, that many parts of the program, where starting it thousands of times would take minutes.
function(slipstick_tests name)
  if(NOT SLIPSTICK_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  add_dependencies(tests ${name})
  slipstick_configure(${name})
  slipstick_compile_quickly(${name})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gmock GTest::gtest_main)
  if(SLIPSTICK_TEST_SHARDS)
    math(EXPR last "${SLIPSTICK_TEST_SHARDS} - 1")
    foreach(shard RANGE ${last})
      add_test(NAME ${name}.part${shard} COMMAND ${name})
      set_tests_properties(${name}.part${shard} PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${SLIPSTICK_TEST_SHARDS};GTEST_SHARD_INDEX=${shard}")
    endforeach()
  else()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS})
  endif()
endfunction()
include(GoogleTest)
