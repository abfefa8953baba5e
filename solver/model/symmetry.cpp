#include "solver/model/symmetry.hpp"

#include <fmt/core.h>

namespace slipstick::solver {

bool reducible(const Scene& scene) {
  return scene.solver.model != ModelChoice::full && scene.solver.op == OperatorKind::dcfft;
}

namespace {

using Eigen::ArrayXd;

/// A field with the symmetries of the friction bound: the pressure, unless a map has others. A step before
/// may have left tractions that are asymmetric like the map elsewhere.
ArrayXd carrying(const Model& model, const ArrayXd& pressure, bool is_first) {
  if (!model.friction.factors) return pressure;
  const ArrayXd bound = model.friction.bound(pressure);
  return is_first ? bound : (pressure > 0.0).select(bound, *model.friction.factors);
}

}  // namespace

bool moves_by_pressure(const Scene& scene, const Model& model) {
  return model.pressure_coupling && model.law->couples() && !scene.contact.friction.is_frictionless();
}

bool has_translations(const Scene& scene, const Model& model, const ArrayXd& pressure, bool is_first) {
  if (scene.solver.method != Method::coulomb) return false;
  return scene.solver.model == ModelChoice::full || model.forces ||
         !is_half_turn_symmetric(model.grid, carrying(model, pressure, is_first));
}

Reduction traction_part(const Scene& scene, const Model& model, const Eigen::ArrayXd& pressure,
                        const Eigen::ArrayXd& before) {
  if (!reducible(scene)) return Reduction(model.grid);
  const ArrayXd occupied = before.size() > 0 ? ArrayXd(pressure.max(before)) : pressure;
  const bool mirrored = !model.pressure_coupling && !model.forces;
  if (mirrored && model.friction.factors && before.size() > 0) {
    const Reduction all(model.grid, carrying(model, pressure, false), ArrayXd::Ones(model.grid.cells()));
    return all.quadrant() ? all : Reduction(model.grid, occupied);
  }
  return mirrored ? Reduction(model.grid, carrying(model, pressure, true), occupied) : Reduction(model.grid, occupied);
}

std::vector<Omission> omissions(const Scene& scene, const Model& model, const Reduction& part, bool translations) {
  std::vector<Omission> left_out = scene.left_out;
  const Grid& grid = part.grid();
  if (!model.pressure_coupling) {
    left_out.push_back({"K13, K23", !model.law->couples() ? "similar materials: pressure moves both surfaces alike"
                                                          : "contact.coupling = \"none\""});
  } else if (!model.shear_coupling && model.law->couples()) {
    left_out.push_back({"K31, K32", "shear leaves the pressure as it is, unless contact.coupling = \"full\""});
  }
  if (!translations) {
    left_out.push_back({"translations", scene.solver.method == Method::coulomb
                                            ? "no force, and half a turn brings the contact onto itself"
                                            : "this method turns about the origin of the grid"});
  }
  if (part.trimmed()) {
    const Index mirrored = part.quadrant() ? 2 : 1;
    left_out.push_back({fmt::format("all but {} x {} of {} x {} cells", mirrored * grid.n1, mirrored * grid.n2,
                                    model.grid.n1, model.grid.n2),
                        "the rest of the grid lies outside the contact's bounding rectangle"});
  }
  if (part.quadrant()) {
    left_out.push_back(
        {"three quarters of the contact", "two mirror axes: q1 is even in x1 and odd in x2, q2 the reverse"});
  }
  if (part.diagonal()) {
    left_out.push_back({"one traction field", "the diagonal is a mirror too: q2(x1, x2) = -q1(x2, x1)"});
  }
  return left_out;
}

}  // namespace slipstick::solver
