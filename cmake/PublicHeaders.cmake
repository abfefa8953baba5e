# Programs include these headers as <slipstick/...>: they are copied to one folder, and include only each other, Eigen and
# the standard library.
set(SLIPSTICK_PUBLIC_HEADERS
  solver/scene/scene.hpp          # the problem: validate(), read_scene()
  solver/scene/surface.hpp        # shapes of the indenter
  solver/scene/friction_law.hpp   # friction bounds under a pressure
  solver/solve.hpp                # Scene in, Solution out
  solver/cache/solve_cache.hpp    # data shared by solves of one size
  solver/solution.hpp             # fields and numbers, SI
  solver/contact/certificate.hpp  # distance of any tractions from the law of friction
  solver/contact/limit_load.hpp   # largest loads of a contact
  solver/grid/grid.hpp            # cells, and the layout of fields
  solver/grid/ranks.hpp           # the processes that share a grid: one by default
  solver/newton/safeguards.hpp      # an iteration's callback, counts of its safeguards
  solver/elasticity/operator_kind.hpp
  solver/input/field_file.hpp     # fields as CSV, HDF5, VTK
  solver/input/input_error.hpp    # the exception for bad input
  analytic/axisymmetric.hpp       # contacts by their pressure
  analytic/torsion.hpp            # exact states: load, twist, stick radius, tractions
  convergence/oracle/oracle.hpp)  # exact answers of scenes

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
