# cmake -D SOURCE_DIR=... -D WORK_DIR=... -P left_out_test.cmake: configures without FLINT, as on a machine that has none.
# What is left out is named with what to install.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK_DIR})
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR} -G Ninja -D SLIPSTICK_TESTS=OFF
    -D CMAKE_DISABLE_FIND_PACKAGE_Arb=ON
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "configuring ended with ${status}:\n${output}")
endif()
file(READ ${WORK_DIR}/left_out.txt left_out)
foreach(words "certified digits" libflint-dev libflint-arb-dev)
  string(FIND "${left_out}" "${words}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "left_out.txt does not say “${words}”:\n${left_out}")
  endif()
endforeach()
file(REMOVE_RECURSE ${WORK_DIR})
