# cmake -D SOURCE_DIR=... -D WORK_DIR=... -P not_built_test.cmake: configures without FLINT, as on a machine that has none.
# Each part that is not built is reported with the packages to install.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK_DIR})
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR} -G Ninja -D SLIPSTICK_TESTS=OFF
    -D CMAKE_DISABLE_FIND_PACKAGE_Arb=ON
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "configuring ended with ${status}:\n${output}")
endif()
file(READ ${WORK_DIR}/not_built.txt not_built)
file(STRINGS ${SOURCE_DIR}/cmake/debian-packages.txt by_setup REGEX "^[^#]")
if(not_built MATCHES "MPI was not found[^\n]*make setup" AND NOT "libopenmpi-dev" IN_LIST by_setup)
  message(FATAL_ERROR "not_built.txt sends to setup, which does not install MPI:\n${not_built}")
endif()
foreach(words "certified digits" libflint-dev libflint-arb-dev)
  string(FIND "${not_built}" "${words}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "not_built.txt does not say “${words}”:\n${not_built}")
  endif()
endforeach()
file(REMOVE_RECURSE ${WORK_DIR})
