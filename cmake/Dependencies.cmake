# Every dependency comes from the distribution; a missing one is named with its Debian/Ubuntu package.

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
slipstick_require(HDF5 libhdf5-dev COMPONENTS C HL)
if(SLIPSTICK_TESTS)
  slipstick_require(GTest "libgtest-dev libgmock-dev")
endif()
if(SLIPSTICK_BENCHMARKS)
  slipstick_require(benchmark libbenchmark-dev)
endif()

# FFTW's own CMake files are broken in several distributions; its pkg-config file is not.
pkg_check_modules(FFTW QUIET IMPORTED_TARGET fftw3 fftw3f)
if(NOT FFTW_FOUND)
  message(FATAL_ERROR "FFTW 3 is missing. On Debian or Ubuntu: apt-get install libfftw3-dev.")
endif()

# Optional: proven digits.
find_package(Arb QUIET)
if(NOT Arb_FOUND)
  message(STATUS "No FLINT with Arb: certified digits are left out. On Debian or Ubuntu: apt-get install libflint-dev "
    "and, before FLINT 3, libflint-arb-dev.")
endif()

# The scripts need an interpreter that can import their packages; the first python3 on PATH often cannot.
function(slipstick_find_python result)
  foreach(candidate "${SLIPSTICK_PYTHON}" /usr/bin/python3 python3)
    if(candidate)
      execute_process(COMMAND "${candidate}" -c "import numpy, matplotlib, jinja2, h5py"
        RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
      if(status EQUAL 0)
        set(${result} "${candidate}" PARENT_SCOPE)
        return()
      endif()
    endif()
  endforeach()
  set(${result} "" PARENT_SCOPE)
endfunction()
set(SLIPSTICK_PYTHON "" CACHE STRING "Python 3 with numpy, matplotlib, jinja2 and h5py")
slipstick_find_python(found_python)
if(found_python)
  set(SLIPSTICK_PYTHON "${found_python}" CACHE STRING "Python 3 with numpy, matplotlib, jinja2 and h5py" FORCE)
else()
  message(WARNING
    "No python3 can import numpy, matplotlib, jinja2 and h5py: the page cannot be drawn. On Debian or Ubuntu: "
    "apt-get install python3-numpy python3-matplotlib python3-jinja2 python3-h5py; elsewhere set SLIPSTICK_PYTHON.")
endif()
