# The target reference writes the committed pages of docs/reference that come from the program and, if doxygen is installed,
# the C++ reference of the public headers (build/docs/cpp/html).
find_program(SLIPSTICK_DOXYGEN doxygen)
mark_as_advanced(SLIPSTICK_DOXYGEN)
if(SLIPSTICK_DOXYGEN)
  configure_file(docs/Doxyfile.in docs/Doxyfile @ONLY)
  set(doxygen ${SLIPSTICK_DOXYGEN} ${PROJECT_BINARY_DIR}/docs/Doxyfile)
  add_custom_target(doxygen COMMAND ${doxygen} COMMENT "Writing docs/cpp/html" VERBATIM)
  if(SLIPSTICK_TESTS)
    add_test(NAME front_door.doxygen COMMAND ${doxygen})
    set_tests_properties(front_door.doxygen PROPERTIES TIMEOUT ${SLIPSTICK_TEST_HANGS})
  endif()
else()
  set(doxygen ${CMAKE_COMMAND} -E echo "NOT BUILT: the C++ reference, because doxygen is not installed")
endif()
add_custom_target(reference
  COMMAND ${SLIPSTICK_PYTHON} -B ${PROJECT_SOURCE_DIR}/docs/generator/reference.py $<TARGET_FILE:slipstick> ${PROJECT_SOURCE_DIR}/docs/reference
  COMMAND ${doxygen}
  COMMENT "Writing docs/reference" VERBATIM)
