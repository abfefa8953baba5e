# Settings of all targets: warnings, optimisation, include root, precompiled headers.

option(SLIPSTICK_CCACHE "Compile through ccache where it is installed" ON)
find_program(SLIPSTICK_CCACHE_PROGRAM ccache)
mark_as_advanced(SLIPSTICK_CCACHE_PROGRAM)
if(SLIPSTICK_CCACHE AND SLIPSTICK_CCACHE_PROGRAM AND "${CMAKE_CXX_COMPILER_LAUNCHER}" MATCHES "^(.*ccache)?$")
  # ccache cannot see the macros of a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
    ${SLIPSTICK_CCACHE_PROGRAM})
endif()
# Half of the compiled code is templates, for which gcc's garbage collector runs too often.
add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1000000>)

# Precompiled headers of other libraries: compiled once per target, or per group of targets with equal flags.
set(SLIPSTICK_HEADERS <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <optional> <ostream> <set>
  <sstream> <string> <variant> <vector> <fmt/format.h>)

function(slipstick_configure target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -ffp-contract=off
    $<$<BOOL:${SLIPSTICK_WERROR}>:-Werror> $<$<BOOL:${SLIPSTICK_NATIVE}>:-march=native>)
endfunction()

# convergence/ spends its time in analytic/ and solver/: -O3 would take half as long again to compile, without effect.
function(slipstick_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Commands and tests call code that is compiled elsewhere, so they need no optimisation.
function(slipstick_compile_unoptimised target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O0>)
endfunction()

# The sources of each folder are compiled as one unit, so that their headers are read once.
option(SLIPSTICK_UNITY "Compile folder by folder: half the time of a first build, more for a single changed file" ON)
function(slipstick_compile_by_folder target sources)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SLIPSTICK_UNITY} UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${folder}")
  endforeach()
endfunction()
# The sources of a program are compiled nine at a time, so that both of two cores have work.
function(slipstick_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SLIPSTICK_UNITY} UNITY_BUILD_BATCH_SIZE 9)
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
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  slipstick_configure(${target})
  slipstick_compile_by_folder(${target} "${ARG_SOURCES}")
endfunction()

# slipstick_module(<name> SOURCES ... LIBRARIES ...): the target slipstick_<name>_module, a library libslipstick_<name> that is
# opened on demand (cmake/loaded_library.hpp). Programs find it by their run paths: in lib/slipstick of the build, in
# SLIPSTICK_MODULES of an installation, in the same folder of a wheel.
set(SLIPSTICK_MODULES ${CMAKE_INSTALL_LIBDIR}/slipstick)
set(CMAKE_BUILD_RPATH ${PROJECT_BINARY_DIR}/lib/slipstick)
# With a sanitizer dlopen() is called by the sanitizer's library, which uses only DT_RPATH of the program.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  add_link_options(-Wl,--disable-new-dtags)
endif()
# slipstick_run_path(<target> <folders...>): sets the run path already in the build. If CMake replaced it during installation, it
# would append a colon, and an empty path means the current folder.
function(slipstick_run_path target)
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "${ARGN}" INSTALL_RPATH_USE_LINK_PATH ON
    BUILD_WITH_INSTALL_RPATH ON)
endfunction()
function(slipstick_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(target slipstick_${name}_module)
  add_library(${target} MODULE ${ARG_SOURCES})
  slipstick_configure(${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME slipstick_${name} CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/slipstick)
  slipstick_run_path(${target})
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES})
  install(TARGETS ${target} LIBRARY DESTINATION ${SLIPSTICK_MODULES})
endfunction()

# Time limit of a test in seconds. The limit is for tests that hang: at least twenty times the duration of the slowest test (the
# mutants) on an idle machine.
set(SLIPSTICK_TEST_HANGS 3600)

# Compiled once for all programs of tests: precompiled headers, and two sources.
if(SLIPSTICK_TESTS)
  add_library(slipstick_test_headers OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/cmake/headers.cpp)
  slipstick_configure(slipstick_test_headers)
  slipstick_compile_unoptimised(slipstick_test_headers)
  target_link_libraries(slipstick_test_headers PRIVATE GTest::gmock fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen)
  target_precompile_headers(slipstick_test_headers PRIVATE ${SLIPSTICK_HEADERS} <Eigen/Core> <nlohmann/json.hpp> <gmock/gmock.h>
    <gtest/gtest.h>)
  foreach(part temporary_folder replay)
    add_library(slipstick_test_${part} OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/cmake/tests/${part}.cpp)
    target_link_libraries(slipstick_test_${part} PRIVATE GTest::gtest)
    slipstick_configure(slipstick_test_${part})
    slipstick_compile_unoptimised(slipstick_test_${part})
  endforeach()
endif()

# slipstick_tests(<name> SOURCES ... LIBRARIES ...): a GoogleTest program; each suite is a test of CTest, <name>.<suite>. Starting
# the program for each of its cases would take a minute in all.
function(slipstick_tests name)
  if(NOT SLIPSTICK_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES} $<TARGET_OBJECTS:slipstick_test_temporary_folder>)
  add_dependencies(tests ${name})
  target_precompile_headers(${name} REUSE_FROM slipstick_test_headers)
  # gcc 12 gives a false warning on std::string's operator+ from a precompiled header.
  target_compile_options(${name} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow>)
  slipstick_configure(${name})
  slipstick_compile_unoptimised(${name})
  slipstick_compile_by_folder(${name} "${ARG_SOURCES}")
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} fmt::fmt GTest::gmock GTest::gtest_main)
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/tests/suites.cmake)
  add_custom_command(TARGET ${name} POST_BUILD BYPRODUCTS ${suites} COMMAND ${CMAKE_COMMAND}
    -D NAME=${name} -D PROGRAM=$<TARGET_FILE:${name}> -D OUTPUT=${suites} -D TIMEOUT=${SLIPSTICK_TEST_HANGS} -P ${script})
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_include.cmake
    "if(EXISTS [==[${suites}]==])\n  include([==[${suites}]==])\nelse()\n  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_include.cmake)
endfunction()

# slipstick_fuzz_target(<name> SOURCE ... LIBRARIES ...): a program <name>_fuzz from one LLVMFuzzerTestOneInput(), and a test that
# runs it on every file of corpus/<name> in the source's folder. With SLIPSTICK_FUZZERS libFuzzer provides main().
option(SLIPSTICK_FUZZERS "Link the fuzz targets with libFuzzer; needs clang, see the preset fuzz" OFF)
if(SLIPSTICK_FUZZERS AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "SLIPSTICK_FUZZERS needs clang, and the compiler is ${CMAKE_CXX_COMPILER_ID}: cmake --preset fuzz")
endif()
function(slipstick_fuzz_target name)
  if(NOT SLIPSTICK_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "SOURCE" "LIBRARIES" ${ARGN})
  set(target ${name}_fuzz)
  cmake_path(GET ARG_SOURCE PARENT_PATH folder)
  add_executable(${target} ${ARG_SOURCE})
  add_dependencies(tests ${target})
  target_precompile_headers(${target} REUSE_FROM slipstick_test_headers)
  slipstick_configure(${target})
  slipstick_compile_unoptimised(${target})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} fmt::fmt GTest::gmock)
  if(SLIPSTICK_FUZZERS)
    add_dependencies(fuzzers ${target})
    target_link_options(${target} PRIVATE -fsanitize=fuzzer)
  else()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:slipstick_test_replay>)
  endif()
  add_test(NAME fuzz.${name} COMMAND ${target} -runs=0 ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/corpus/${name})
  set_tests_properties(fuzz.${name} PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS})
endfunction()
if(SLIPSTICK_FUZZERS)
  add_custom_target(fuzzers)  # all fuzz targets
endif()
