# The programs that measure.

add_executable(slipstick_benchmarks
  suite/exact_benchmark.cpp suite/influence_benchmark.cpp suite/operator_benchmark.cpp
  suite/slipstick_benchmarks.cpp suite/solve_benchmark.cpp suite/suite.cpp)
slipstick_configure(slipstick_benchmarks)
target_precompile_headers(slipstick_benchmarks PRIVATE ${SLIPSTICK_HEADERS} <Eigen/Core> <nlohmann/json.hpp>
  <benchmark/benchmark.h>)
target_link_libraries(slipstick_benchmarks PRIVATE slipstick::analytic slipstick_reference_tables
  slipstick::bench PkgConfig::FFTW GSL::gsl fmt::fmt benchmark::benchmark)
# Each time is printed with its error: of the exact side against the tests' references, of the solver in the scenes that come with the program.
target_compile_definitions(slipstick_benchmarks PRIVATE SLIPSTICK_SCENES="${PROJECT_SOURCE_DIR}/convergence/scenes")

# Counts the work that solves take: the linker puts the functions of work/work_counts.cpp in the place of those counted.
add_executable(slipstick_work work/work_program.cpp work/work_counts.cpp)
slipstick_configure(slipstick_work)
target_link_libraries(slipstick_work PRIVATE slipstick::convergence slipstick::solver slipstick::allocations PkgConfig::FFTW
  CLI11::CLI11 fmt::fmt)
target_compile_definitions(slipstick_work PRIVATE SLIPSTICK_SCENES="${PROJECT_SOURCE_DIR}/convergence/scenes")
foreach(function
    fftw_plan_dft_1d fftw_plan_many_dft
    fftw_plan_many_dft_r2c fftw_plan_many_dft_c2r
    fftw_execute_dft fftw_execute_dft_r2c
    fftw_execute_dft_c2r
    _ZN9slipstick6solver13integrate_rowERNS0_7CellRowEldddd)
  target_link_options(slipstick_work PRIVATE -Wl,--wrap=${function})
endforeach()
if(SLIPSTICK_TESTS AND SLIPSTICK_PYTHON)
  add_dependencies(tests slipstick_work)
  add_test(NAME bench.work_counts COMMAND ${SLIPSTICK_PYTHON} -B ${SLIPSTICK_RUN_TEST}
    ${PROJECT_SOURCE_DIR}/bench/work/tests/work_counts_test.py $<TARGET_FILE:slipstick_work>)
  set_tests_properties(bench.work_counts PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS})
endif()

# Needs a quarter of an hour on an idle machine, so only `make bench-trust` runs it.
include(tests/sleeping_operator.cmake)
add_mutant(sleeping_operator MUTANTS ${CMAKE_CURRENT_SOURCE_DIR}/tests/sleeping_operator.cmake
  ORIGINAL slipstick_benchmarks)
set(SLIPSTICK_TRIES 40 CACHE STRING "Tries of the comparison of timings that bench-trust makes")
add_custom_target(bench-trust
  COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:slipstick> -D BENCHMARKS=$<TARGET_FILE:slipstick_benchmarks>
    -D SLOWER=$<TARGET_FILE:slipstick_mutant_sleeping_operator> -D WORK_DIR=${CMAKE_CURRENT_BINARY_DIR}/trust
    -D TRIES=${SLIPSTICK_TRIES} -P ${CMAKE_CURRENT_SOURCE_DIR}/tests/trust_test.cmake
  DEPENDS slipstick slipstick_benchmarks slipstick_mutant_sleeping_operator USES_TERMINAL)
