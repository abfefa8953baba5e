# Arb is the library libarb (libflint-arb on Debian) with FLINT 2, and a part of FLINT since FLINT 3.
# Defines Arb_FOUND, Arb_VERSION_FLINT (2 or 3) and the target Arb::arb.
include(CheckCXXSourceCompiles)
include(FindPackageHandleStandardArgs)

find_path(Arb_FLINT_INCLUDE_DIR flint/fmpq.h)
find_library(Arb_FLINT_LIBRARY flint)
find_library(Arb_GMP_LIBRARY gmp)
find_library(Arb_MPFR_LIBRARY mpfr)

if(EXISTS "${Arb_FLINT_INCLUDE_DIR}/flint/arb.h")
  set(Arb_VERSION_FLINT 3)
  set(Arb_HEADER_DIR "${Arb_FLINT_INCLUDE_DIR}")
  set(Arb_NEEDED Arb_FLINT_LIBRARY)
  set(arb_libraries ${Arb_FLINT_LIBRARY} ${Arb_MPFR_LIBRARY} ${Arb_GMP_LIBRARY})
else()
  set(Arb_VERSION_FLINT 2)
  find_path(Arb_INCLUDE_DIR arb.h)
  find_library(Arb_LIBRARY NAMES flint-arb arb)
  set(Arb_HEADER_DIR "${Arb_INCLUDE_DIR}")
  set(Arb_NEEDED Arb_LIBRARY Arb_FLINT_LIBRARY)
  set(arb_libraries ${Arb_LIBRARY} ${Arb_FLINT_LIBRARY} ${Arb_MPFR_LIBRARY} ${Arb_GMP_LIBRARY})
endif()

# Headers and libraries may come from different installations: only linking a program shows that they match.
if(Arb_FLINT_INCLUDE_DIR AND Arb_HEADER_DIR AND arb_libraries AND NOT arb_libraries MATCHES "NOTFOUND")
  set(CMAKE_REQUIRED_INCLUDES ${Arb_FLINT_INCLUDE_DIR} ${Arb_HEADER_DIR})
  set(CMAKE_REQUIRED_LIBRARIES ${arb_libraries})
  check_cxx_source_compiles("
    #if __has_include(<flint/arb.h>)
    #include <flint/arb.h>
    #else
    #include <arb.h>
    #endif
    int main() { arb_t x; arb_init(x); arb_const_pi(x, 64); arb_clear(x); }" Arb_LINKS)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()

find_package_handle_standard_args(Arb
  REQUIRED_VARS ${Arb_NEEDED} Arb_HEADER_DIR Arb_FLINT_INCLUDE_DIR Arb_GMP_LIBRARY Arb_MPFR_LIBRARY Arb_LINKS)
mark_as_advanced(Arb_FLINT_INCLUDE_DIR Arb_FLINT_LIBRARY Arb_GMP_LIBRARY Arb_MPFR_LIBRARY Arb_INCLUDE_DIR
  Arb_LIBRARY)

if(Arb_FOUND AND NOT TARGET Arb::arb)
  add_library(Arb::arb INTERFACE IMPORTED)
  set_target_properties(Arb::arb PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Arb_FLINT_INCLUDE_DIR};${Arb_HEADER_DIR}"
    INTERFACE_LINK_LIBRARIES "${arb_libraries}")
endif()
unset(arb_libraries)
