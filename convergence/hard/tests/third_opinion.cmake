# hard.third_opinion: contacts solved by Siconos too, where it is installed with FCLIB's format and h5py is there to
# write it (Debian: libsiconos-numerics-dev libfclib-dev python3-h5py). Nothing else needs them.
find_path(SLIPSTICK_SICONOS_INCLUDE_DIR FrictionContactProblem.h PATH_SUFFIXES siconos/numerics)
find_path(SLIPSTICK_FCLIB_INCLUDE_DIR fclib.h)
find_library(SLIPSTICK_SICONOS_LIBRARY siconos_numerics)
find_library(SLIPSTICK_FCLIB_LIBRARY fclib)
mark_as_advanced(SLIPSTICK_SICONOS_INCLUDE_DIR SLIPSTICK_FCLIB_INCLUDE_DIR SLIPSTICK_SICONOS_LIBRARY SLIPSTICK_FCLIB_LIBRARY)
execute_process(COMMAND ${SLIPSTICK_PYTHON} -c "import h5py" RESULT_VARIABLE no_h5py OUTPUT_QUIET ERROR_QUIET)
if(SLIPSTICK_SICONOS_INCLUDE_DIR AND SLIPSTICK_FCLIB_INCLUDE_DIR AND SLIPSTICK_SICONOS_LIBRARY AND SLIPSTICK_FCLIB_LIBRARY
   AND NOT no_h5py)
  add_executable(fclib_solve ${CMAKE_CURRENT_LIST_DIR}/fclib_solve.c)
  add_dependencies(tests fclib_solve)
  target_include_directories(fclib_solve SYSTEM PRIVATE ${SLIPSTICK_SICONOS_INCLUDE_DIR}
    ${SLIPSTICK_SICONOS_INCLUDE_DIR}/.. ${SLIPSTICK_FCLIB_INCLUDE_DIR})
  target_link_libraries(fclib_solve PRIVATE ${SLIPSTICK_FCLIB_LIBRARY} ${SLIPSTICK_SICONOS_LIBRARY})
  add_test(NAME hard.third_opinion
    COMMAND ${SLIPSTICK_PYTHON} -B ${SLIPSTICK_RUN_TEST} ${CMAKE_CURRENT_LIST_DIR}/third_opinion_test.py $<TARGET_FILE:slipstick>
      $<TARGET_FILE:fclib_solve>)
  set_tests_properties(hard.third_opinion PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS})
else()
  slipstick_not_tested(hard.third_opinion
    "no Siconos, FCLIB or h5py; install libsiconos-numerics-dev libfclib-dev python3-h5py")
endif()
