# The harness tests itself: each mutant is the program with one source file changed, compiled anew and linked before the
# library that holds the original. Built by their test alone.
include(${CMAKE_CURRENT_LIST_DIR}/mutants.cmake)

foreach(name IN LISTS mutants)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/mutants/${name}.cpp")
  set(original "${mutant_${name}_FILE}")
  add_custom_command(OUTPUT "${source}"
    COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D SOURCE_DIR=${PROJECT_SOURCE_DIR} -D OUTPUT=${source}
      -P ${CMAKE_CURRENT_LIST_DIR}/mutate.cmake
    DEPENDS "${PROJECT_SOURCE_DIR}/${original}" ${CMAKE_CURRENT_LIST_DIR}/mutants.cmake
      ${CMAKE_CURRENT_LIST_DIR}/mutate.cmake)
  cmake_path(GET original PARENT_PATH folder)
  set(target slipstick_mutant_${name})
  add_executable(${target} EXCLUDE_FROM_ALL "${source}" $<TARGET_OBJECTS:slipstick>)
  slipstick_configure(${target})
  target_include_directories(${target} PRIVATE $<TARGET_PROPERTY:slipstick_${folder},INCLUDE_DIRECTORIES>)
  target_link_libraries(${target} PRIVATE $<TARGET_PROPERTY:slipstick,LINK_LIBRARIES>)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/mutants")
  list(APPEND mutant_targets ${target})
endforeach()
add_custom_target(slipstick_mutants DEPENDS ${mutant_targets})

add_test(NAME mutants
  COMMAND ${CMAKE_COMMAND} -D BUILD_DIR=${PROJECT_BINARY_DIR} -D MUTANTS=${CMAKE_CURRENT_BINARY_DIR}/mutants
    -D PROGRAM=$<TARGET_FILE:slipstick> -D GATES=${CMAKE_CURRENT_SOURCE_DIR}/gates/quick.toml
    -D WORK_DIR=${CMAKE_CURRENT_BINARY_DIR}/mutants/results -P ${CMAKE_CURRENT_LIST_DIR}/mutants_test.cmake)
set_tests_properties(mutants PROPERTIES LABELS mutants TIMEOUT 900 PROCESSORS 2 COST 200)
