# The reference data set (make dataset): a part of it is made and read by its test. It needs proven digits, mpmath and the Python
# package; with Siconos, hard/tests/third_opinion.cmake has built fclib_solve.
if(Arb_FOUND AND SLIPSTICK_MPMATH AND SLIPSTICK_INTERFACES)
  set(solver $<$<TARGET_EXISTS:fclib_solve>:$<TARGET_FILE:fclib_solve>>)
  add_test(NAME convergence.dataset
    COMMAND ${SLIPSTICK_PYTHON} -B ${SLIPSTICK_RUN_TEST} ${CMAKE_CURRENT_LIST_DIR}/tests/dataset_test.py $<TARGET_FILE:slipstick> ${solver}
    COMMAND_EXPAND_LISTS)
  set_tests_properties(convergence.dataset PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS} PROCESSORS 2
    ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
else()
  message(STATUS "no convergence.dataset: it needs FLINT with Arb, mpmath and the Python package")
endif()
