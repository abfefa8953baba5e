#pragma once

#include "convergence/check/foreign_field.hpp"
#include "convergence/oracle.hpp"
#include "solver/model.hpp"
#include "solver/scene.hpp"

namespace slipstick::convergence {

/// The field in this project's conventions, with a note for each that was another one: units of length (by
/// the contact's size) and of stress (by the load that it carries), axes exchanged (by the shape of an
/// elliptic contact), another origin, and components of the traction reversed or exchanged (by the loads that
/// they carry). model: the scene's. Throws InputError where no unit fits.
ForeignField in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                const OracleAnswer& exact);

}  // namespace slipstick::convergence
