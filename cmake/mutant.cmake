# A mutant is the program with a known mistake in one source file, which the gates must detect. The replaced text must occur
# exactly once in the file.

# mutant(<name> FILE <source> FIND <text> REPLACE <text> GATES <ids...>)
function(mutant name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "FILE;FIND;REPLACE" "GATES")
  set(names ${mutants} ${name})
  set(mutants "${names}" PARENT_SCOPE)
  foreach(key FILE FIND REPLACE GATES)
    set(mutant_${name}_${key} "${ARG_${key}}" PARENT_SCOPE)
  endforeach()
endfunction()

# add_mutant(<name> MUTANTS <list file> ORIGINAL <target>): the executable slipstick_mutant_<name>: `original`, linked with the
# mutated source before the library with the unchanged source. Built on demand.
function(add_mutant name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "MUTANTS;ORIGINAL" "")
  set(source "${CMAKE_CURRENT_BINARY_DIR}/mutants/${name}.cpp")
  set(file "${mutant_${name}_FILE}")
  set(mutate "${PROJECT_SOURCE_DIR}/cmake/mutate.cmake")
  add_custom_command(OUTPUT "${source}"
    COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D MUTANTS=${ARG_MUTANTS} -D SOURCE_DIR=${PROJECT_SOURCE_DIR}
      -D OUTPUT=${source} -P ${mutate}
    DEPENDS "${PROJECT_SOURCE_DIR}/${file}" "${ARG_MUTANTS}" ${mutate})
  string(REGEX REPLACE "/.*" "" folder "${file}")
  set(target slipstick_mutant_${name})
  add_executable(${target} EXCLUDE_FROM_ALL "${source}" $<TARGET_OBJECTS:${ARG_ORIGINAL}>)
  slipstick_configure(${target})
  # As convergence/ is compiled, whose precompiled headers are used.
  slipstick_compile_quickly(${target})
  target_compile_options(${target} PRIVATE -fPIC)
  target_precompile_headers(${target} REUSE_FROM slipstick_convergence)
  target_include_directories(${target} PRIVATE $<TARGET_PROPERTY:slipstick_${folder},INCLUDE_DIRECTORIES>)
  target_link_libraries(${target} PRIVATE $<TARGET_PROPERTY:${ARG_ORIGINAL},LINK_LIBRARIES> tomlplusplus::tomlplusplus)
  # The unchanged folder is linked too, as one unit. The linker uses the first of two equal functions, also for calls within the
  # unit, since the code is position-independent.
  target_link_options(${target} PRIVATE -Wl,--allow-multiple-definition)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/mutants")
endfunction()
