#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/foreign_field.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// A field in this project's conventions.
struct Interpretation {
  ForeignField field;
  std::vector<std::string> conventions;  ///< conventions that were undone, one sentence each
  std::vector<std::string> mistakes;     ///< mistakes that were undone, so that the rest can be judged
};

/// Finds the conventions in which a field fits the scene best, in this order:
///
///  1. unit of length: the contact's size shows it;
///  2. unit of stress: the load that the pressure carries shows it;
///  3. exchanged axes: the shape of an elliptic contact shows them;
///  4. origin: the contact's middle is moved onto the body's axis, or from the grid's corner to its middle;
///  5. tractions on the other body, a left-handed frame, exchanged columns: the loads that the tractions
///  carry
///     show them. One reversed component is a mistake.
///
/// model: the scene's. Throws InputError where no unit fits.
Interpretation in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                  const OracleAnswer& exact);

/// A scene's moment over `unit`, from the exact answer or the scene's load. limit: the limit moment of the
/// pressure, over the same unit. None under an imposed twist without an exact answer.
std::optional<double> known_moment(const solver::Scene& scene, const OracleAnswer& exact, double limit,
                                   double unit);

}  // namespace slipstick::convergence
