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
  std::vector<std::string> conventions;  ///< other ones that it was in, one sentence each
  std::vector<std::string> mistakes;     ///< what no convention is, and was undone to judge the rest
  std::vector<std::string> remarks;      ///< what else is odd about it
};

/// Finds the conventions in which a field fits the scene best: units of length (by the contact's size) and of
/// stress (by the load that it carries), axes exchanged (by the shape of an elliptic contact), another
/// origin, tractions on the other body, a left-handed frame, and the order of the tractions' columns (by the
/// loads that they carry). One component reversed alone is a mistake. model: the scene's. Throws InputError
/// where no unit fits.
Interpretation in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                  const OracleAnswer& exact);

/// A scene's moment over a unit, by the exact answer or as a load, under a pressure with a limit moment over
/// that unit. None under an imposed twist without an exact answer.
std::optional<double> known_moment(const solver::Scene& scene, const OracleAnswer& exact, double limit,
                                   double unit);

}  // namespace slipstick::convergence
