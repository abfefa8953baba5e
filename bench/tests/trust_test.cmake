# cmake -D PROGRAM=<slipstick> -D BENCHMARKS=<program> -D SLOWER=<program> -D WORK_DIR=... -D TRIES=40 -P trust_test.cmake:
# can the comparison be trusted? A build against itself must be green in every try, and one whose operator sleeps for 15 %
# of its time must be called slower in every try. Takes a quarter of an hour of an otherwise idle machine.
cmake_minimum_required(VERSION 3.25)
set(FILTER "^application/dcfft/cells:256$")

function(try number now result)
  set(folder "${WORK_DIR}/${number}")
  file(MAKE_DIRECTORY "${folder}")
  execute_process(
    COMMAND "${PROGRAM}" bench --program "${now}" --against "${BENCHMARKS}" --filter "${FILTER}" --output "${folder}"
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE complaint)
  file(WRITE "${folder}/comparison.txt" "${output}${complaint}")
  string(REGEX MATCHALL "[0-9.]+ +[0-9.]+ to [0-9.]+" ratios "${output}")
  message("try ${number}: exit code ${status}, ratios ${ratios}")
  set(${result} "${status}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
set(green 0)
set(found 0)
foreach(number RANGE 1 ${TRIES})
  try("same-${number}" "${BENCHMARKS}" status)
  if(status EQUAL 0)
    math(EXPR green "${green} + 1")
  endif()
  try("slower-${number}" "${SLOWER}" status)
  if(status EQUAL 1)
    math(EXPR found "${found} + 1")
  endif()
endforeach()
message("the same build: green in ${green} of ${TRIES}; 15 % slower: found in ${found} of ${TRIES}")
if(NOT (green EQUAL TRIES AND found EQUAL TRIES))
  message(FATAL_ERROR "the comparison cannot be trusted on this machine")
endif()
