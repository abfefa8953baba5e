# Writes the commit into a header at every build; changes the header only if the commit has changed.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)  # sources without git, of which the caller knows the commit
  set(commit "$ENV{SLIPSTICK_COMMIT}")
endif()
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT
  "#pragma once\n\nnamespace slipstick::convergence {\ninline constexpr char kCommit[] = \"@commit@\";\n}\n" @ONLY)
