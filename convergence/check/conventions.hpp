#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/foreign_field.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/model.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// A field in this project's conventions.
struct Interpretation {
  ForeignField field;
  std::vector<std::string> conventions;  ///< conventions that were undone, one sentence each
  std::vector<std::string> mistakes;     ///< mistakes that were undone, so that the rest can be judged
};

/// Finds the conventions in which a field fits the scene best. The contact's size shows the unit of length,
/// its load the unit of stress, the shape of an elliptic contact exchanged axes, its middle another origin.
/// The loads that the tractions carry show tractions on the other body, a left-handed frame and exchanged
/// columns. One component reversed alone is a mistake. model: the scene's. Throws InputError where no unit
/// fits.
Interpretation in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                  const OracleAnswer& exact);

/// A scene's moment over `unit`, from the exact answer or the scene's load. limit: the limit moment of the
/// pressure, over the same unit. None under an imposed twist without an exact answer.
std::optional<double> known_moment(const solver::Scene& scene, const OracleAnswer& exact, double limit,
                                   double unit);

}  // namespace slipstick::convergence
