#pragma once

#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The order in the cell size with which an error falls, and the reason in one sentence; NaN where theory gives none.
struct ExpectedOrder {
  double value;
  std::string why;
};

/// An error that a study follows if there is an exact answer.
struct ErrorQuantity {
  std::string path;   ///< into a result
  std::string label;  ///< in tables
};
const std::vector<ErrorQuantity>& error_quantities();

/// Quantities that a study follows if the exact answer does not have them.
const std::vector<std::string>& value_quantities();

/// The powers of the cell size in the error of a number of loads or motions where the edges of contact and
/// stick are straight and lie between cells, and the tractions there are singular: the leading ones.
const std::vector<double>& aligned_edge_powers();

/// The order of an error, or of a value's error, in a scene. It follows from the pressure model and from how
/// the indenter's pressure ends.
ExpectedOrder expected_order(const std::string& quantity, const solver::Scene& scene);

}  // namespace slipstick::convergence
