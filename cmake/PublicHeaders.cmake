# The headers that programs include as <slipstick/...>: copies of those named here, in one folder. They include each other,
# Eigen and the standard library, nothing else.
set(SLIPSTICK_PUBLIC_HEADERS
  solver/scene/scene.hpp          # what to solve: validate(), read_scene()
  solver/scene/surface.hpp        # shapes of the indenter
  solver/scene/friction_law.hpp   # what shear a pressure carries
  solver/solve.hpp                # Scene in, Solution out
  solver/cache/solve_cache.hpp    # what solves of one size share
  solver/solution.hpp             # fields and numbers, SI
  solver/contact/certificate.hpp  # how far tractions, anyone's, are from Coulomb's law
  solver/contact/limit_load.hpp   # what a contact carries before all of it slides
  solver/grid/grid.hpp            # cells, and how fields lie over them
  solver/grid/ranks.hpp           # the processes that share a grid: one, unless the program says otherwise
  solver/newton/safeguards.hpp    # what a solve did beside plain steps
  solver/elasticity/operator_kind.hpp
  solver/input/field_file.hpp     # fields as CSV, HDF5, VTK
  solver/input/input_error.hpp    # what is thrown for bad input
  analytic/axisymmetric.hpp       # contacts by their pressure
  analytic/torsion.hpp            # exact states: load, twist, stick radius, tractions
  convergence/oracle/oracle.hpp)  # the exact answer for a scene

set(SLIPSTICK_PUBLIC_INCLUDE "${PROJECT_BINARY_DIR}/include")
set(names)
foreach(header ${SLIPSTICK_PUBLIC_HEADERS})
  cmake_path(GET header FILENAME name)
  list(APPEND names ${name})
endforeach()
foreach(header ${SLIPSTICK_PUBLIC_HEADERS})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  cmake_path(GET header FILENAME name)
  file(READ ${header} text)
  string(REGEX REPLACE "#include \"[a-z_/]*/([a-z_]+\\.hpp)\"" "#include <slipstick/\\1>" text "${text}")
  string(REGEX MATCHALL "#include <slipstick/[a-z_]+\\.hpp>" includes "${text}")
  foreach(include ${includes})
    string(REGEX REPLACE ".*/([a-z_]+\\.hpp)>" "\\1" included "${include}")
    if(NOT included IN_LIST names)
      message(FATAL_ERROR "${header} is public and includes ${included}, which is not: see cmake/PublicHeaders.cmake")
    endif()
  endforeach()
  file(CONFIGURE OUTPUT "${SLIPSTICK_PUBLIC_INCLUDE}/slipstick/${name}" CONTENT "${text}" @ONLY)
endforeach()
