# Tests of the gates: each mutant is the program with one source file changed and linked before the library of the
# original. Only the test `mutants` builds them.
include(${CMAKE_CURRENT_LIST_DIR}/mutants.cmake)

foreach(name IN LISTS mutants)
  add_mutant(${name} MUTANTS ${CMAKE_CURRENT_LIST_DIR}/mutants.cmake ORIGINAL slipstick)
  list(APPEND mutant_targets slipstick_mutant_${name})
endforeach()
add_custom_target(slipstick_mutants DEPENDS ${mutant_targets})

add_test(NAME mutants
  COMMAND ${CMAKE_COMMAND} -D BUILD_DIR=${PROJECT_BINARY_DIR} -D MUTANTS=${CMAKE_CURRENT_BINARY_DIR}/mutants
    -D PROGRAM=$<TARGET_FILE:slipstick> -D GATES=${CMAKE_CURRENT_SOURCE_DIR}/gates/quick.toml
    -D WORK_DIR=${CMAKE_CURRENT_BINARY_DIR}/mutants/results -P ${CMAKE_CURRENT_LIST_DIR}/mutants_test.cmake)
set_tests_properties(mutants PROPERTIES LABELS mutants TIMEOUT ${SLIPSTICK_TEST_HANGS} PROCESSORS 2 COST 200)
