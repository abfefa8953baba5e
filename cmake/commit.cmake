# Writes the commit into a header; run at every build, touches the header only when it changes.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT
  "#pragma once\n\nnamespace slipstick::convergence {\ninline constexpr char kCommit[] = \"@commit@\";\n}\n" @ONLY)
