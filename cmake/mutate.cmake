# cmake -D NAME=... -D MUTANTS=<list> -D SOURCE_DIR=... -D OUTPUT=... -P mutate.cmake: writes the mutated source.
cmake_minimum_required(VERSION 3.25)
include("${MUTANTS}")

file(READ "${SOURCE_DIR}/${mutant_${NAME}_FILE}" source)
string(FIND "${source}" "${mutant_${NAME}_FIND}" first)
string(FIND "${source}" "${mutant_${NAME}_FIND}" last REVERSE)
if(first EQUAL -1 OR NOT first EQUAL last)
  message(FATAL_ERROR "mutant ${NAME}: ${mutant_${NAME}_FILE} must hold exactly once: ${mutant_${NAME}_FIND}")
endif()
string(REPLACE "${mutant_${NAME}_FIND}" "${mutant_${NAME}_REPLACE}" source "${source}")
file(WRITE "${OUTPUT}" "${source}")
