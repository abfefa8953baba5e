# All dependencies are packages of the distribution; if one is missing, its Debian/Ubuntu package is named.

# slipstick_not_built(<part> <reason and package>): reports a part that is left out, when configuring ends and after every make.
# If the reason names `make setup`, make configures again, since setup installs the package.
function(slipstick_not_built what why)
  set_property(GLOBAL APPEND_STRING PROPERTY SLIPSTICK_NOT_BUILT "NOT BUILT: ${what}, because ${why}\n")
endfunction()

# slipstick_not_tested(<test> <reason and package>): reports an optional test that is left out, after `make test`.
function(slipstick_not_tested test why)
  set_property(GLOBAL APPEND_STRING PROPERTY SLIPSTICK_NOT_TESTED "${test}: ${why}\n")
endfunction()

# slipstick_say_what_is_not_built(): writes not_built.txt, empty if every part is built, and warns.
function(slipstick_say_what_is_not_built)
  get_property(not_built GLOBAL PROPERTY SLIPSTICK_NOT_BUILT)
  file(WRITE "${PROJECT_BINARY_DIR}/not_built.txt" "${not_built}")
  get_property(not_tested GLOBAL PROPERTY SLIPSTICK_NOT_TESTED)
  file(WRITE "${PROJECT_BINARY_DIR}/not_tested.txt" "${not_tested}")
  if(not_built)
    message(WARNING "${not_built}")
  endif()
endfunction()

# slipstick_require(<package> <debian package> [find_package arguments...])
macro(slipstick_require package debian_package)
  find_package(${package} QUIET ${ARGN})
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR
      "${package} is missing. On Debian or Ubuntu: apt-get install ${debian_package} "
      "(or run `make setup`, which installs all that is needed).")
  endif()
endmacro()

slipstick_require(PkgConfig pkg-config)
slipstick_require(Threads libc6-dev)
slipstick_require(Eigen3 libeigen3-dev 3.4 NO_MODULE)
slipstick_require(GSL libgsl-dev 2.7)
slipstick_require(CLI11 libcli11-dev)
slipstick_require(fmt libfmt-dev)
slipstick_require(nlohmann_json nlohmann-json3-dev 3.10)
slipstick_require(tomlplusplus libtomlplusplus-dev)
if(SLIPSTICK_HDF5 OR SLIPSTICK_TESTS)
  slipstick_require(HDF5 libhdf5-dev COMPONENTS C)
endif()
if(SLIPSTICK_TESTS)
  slipstick_require(GTest "libgtest-dev libgmock-dev")
endif()
if(SLIPSTICK_BENCHMARKS)
  slipstick_require(benchmark libbenchmark-dev)
endif()

# In several distributions FFTW's own CMake files are broken; its pkg-config file works.
pkg_check_modules(FFTW QUIET IMPORTED_TARGET fftw3)
if(NOT FFTW_FOUND)
  message(FATAL_ERROR "FFTW 3 is missing. On Debian or Ubuntu: apt-get install libfftw3-dev.")
endif()

# Optional: one contact on several ranks.
# find_package(MPI) fails with an error if MPI's programs are installed without headers and libraries.
find_library(SLIPSTICK_MPI_LIBRARY NAMES mpi mpich)
mark_as_advanced(SLIPSTICK_MPI_LIBRARY)
set(found_mpi OFF)
if(SLIPSTICK_MPI_LIBRARY)
  find_package(MPI QUIET COMPONENTS C)
  set(found_mpi ${MPI_C_FOUND})
endif()
option(SLIPSTICK_MPI "Solve one contact on several ranks: mpirun -n P slipstick solve" ${found_mpi})
# Open MPI requires two settings to run as root, and one to run several ranks on a processor.
set(SLIPSTICK_MPIRUN OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
  OMPI_MCA_mpi_yield_when_idle=1)
if(NOT found_mpi)
  set(why "MPI was not found: install libopenmpi-dev openmpi-bin, then run cmake --preset release")
  if(SLIPSTICK_MPI)
    message(FATAL_ERROR "SLIPSTICK_MPI: ${why}")
  endif()
  slipstick_not_built("solves on several ranks (mpirun) and their tests" "${why}")
endif()

# Optional: proven digits.
option(SLIPSTICK_CERTIFIED "Certified digits, where FLINT is found" ON)
if(SLIPSTICK_CERTIFIED)
  find_package(Arb QUIET)
endif()
if(SLIPSTICK_CERTIFIED AND NOT Arb_FOUND)
  slipstick_not_built("certified digits (slipstick exact --certified) and their tests"
    "FLINT with Arb was not found: install libflint-dev and, before FLINT 3, libflint-arb-dev (or run `make setup`)")
endif()

# The scripts need an interpreter that can import their packages; the first python3 on PATH often cannot.
function(slipstick_find_python result)
  foreach(candidate "${SLIPSTICK_PYTHON}" /usr/bin/python3 python3)
    if(candidate)
      execute_process(COMMAND "${candidate}" -I -c "import numpy, scipy, matplotlib, jinja2, h5py"
        RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
      if(status EQUAL 0)
        set(${result} "${candidate}" PARENT_SCOPE)
        return()
      endif()
    endif()
  endforeach()
  set(${result} "" PARENT_SCOPE)
endfunction()
set(SLIPSTICK_PYTHON "" CACHE STRING "Python 3 with numpy, scipy, matplotlib, jinja2 and h5py")
slipstick_find_python(found_python)
if(found_python)
  set(SLIPSTICK_PYTHON "${found_python}" CACHE STRING "Python 3 with numpy, scipy, matplotlib, jinja2 and h5py" FORCE)
else()
  slipstick_not_built("the page, all figures and their tests"
    "no python3 can import numpy, scipy, matplotlib, jinja2 and h5py: install python3-numpy python3-scipy python3-matplotlib python3-jinja2 \
python3-h5py (or run `make setup`), or set SLIPSTICK_PYTHON")
endif()

set(SLIPSTICK_RUN_TEST ${PROJECT_SOURCE_DIR}/convergence/tests/run_test.py)  # runs the cases of another file

# Optional: reads docs/schema.
if(SLIPSTICK_TESTS AND SLIPSTICK_PYTHON)
  execute_process(COMMAND "${SLIPSTICK_PYTHON}" -c "from jsonschema import Draft202012Validator"
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(status EQUAL 0)
    set(SLIPSTICK_JSONSCHEMA ON)
  else()
    slipstick_not_built("the test that holds results to docs/schema"
      "${SLIPSTICK_PYTHON} cannot import jsonschema 4: install python3-jsonschema (or run `make setup`)")
  endif()
endif()

# Optional: computes what proven digits are compared with.
if(SLIPSTICK_TESTS AND SLIPSTICK_PYTHON)
  execute_process(COMMAND "${SLIPSTICK_PYTHON}" -c "import mpmath" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(status EQUAL 0)
    set(SLIPSTICK_MPMATH ON)
  else()
    slipstick_not_built("the test of certified digits"
      "${SLIPSTICK_PYTHON} cannot import mpmath: install python3-mpmath (or run `make setup`)")
  endif()
endif()

# Optional: counts instructions.
find_program(SLIPSTICK_VALGRIND valgrind)
mark_as_advanced(SLIPSTICK_VALGRIND)
if(SLIPSTICK_BENCHMARKS AND NOT SLIPSTICK_VALGRIND)
  slipstick_not_built("counts of instructions, without which gates on them fail"
    "valgrind was not found: install valgrind (or run `make setup`)")
endif()
