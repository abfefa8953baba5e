#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "solver/contact/full_coupling.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/contact/tangential_problem.hpp"
#include "solver/model/model.hpp"

namespace slipstick::solver {

/// The contact at the start or the end of a step, in the model's units.
struct ContactState {
  NormalSolution normal;  ///< its pressure is empty before the bodies touch
  /// N: the step's load under which that pressure was found. A step under the same load keeps the pressure.
  std::optional<double> normal_load;
  Eigen::ArrayXd traction;  ///< 2*cells; empty before the bodies touch
  /// 2*cells, of each cell since it last stuck or turned back; empty where the contact has just grown.
  Eigen::ArrayXd slip;
  RigidMotion motion;  ///< since the first step began
  /// The largest q.Kq/2 so far, over the cell area, reduced to the part that the friction bounds could still
  /// hold in each step since. A step's certificate is relative to it where the step itself leaves less.
  double energy = 0.0;

  /// No step has been solved yet.
  bool untouched() const { return normal.pressure.size() == 0; }
};

/// Loads nearer to their limit than this are at it: a pressure balances its load to this part.
inline constexpr double kAtLimit = 1e-12;

/// A step's tangential problem, and the largest loads that its contact can carry.
struct LoadStep {
  TangentialProblem problem;
  double moment_limit;     ///< over the cell area, without force
  LimitLoad limit;         ///< of the loads that the step imposes
  bool is_coulomb = true;  ///< the bound is mu p

  /// False for loads beyond the limit, and at it.
  bool carried() const { return limit.factor > 1.0 + kAtLimit; }
};

/// The change that a step of a scene brings to a contact under its pressure, on the model's grid.
LoadStep load_step(const Scene& scene, const Model& model, const Step& step, const Eigen::ArrayXd& pressure,
                   const ContactState& before);

/// Throws InputError for gross slip, with the limit loads of the contact and the motion in which it would slide.
void require_carried(const Scene& scene, const Model& model, const Step& step, const LoadStep& loads);

/// Tractions on the whole grid, the loads that they carry, and the omissions of the model.
struct FoundTractions {
  LoadStep loads;  ///< without the fields of its problem that only the solve needs: initial_displacement, start
  TangentialSolution solution;
  std::vector<Omission> left_out;
};

/// The tractions of a step under its pressure. goal: of a turn under full coupling.
FoundTractions find_tractions(const Scene& scene, const Model& model, LoadStep loads, const Eigen::ArrayXd& pressure,
                              const ContactState& before, const Progress& progress, const StaggeredTarget& goal = {});

/// The slip of the step with that of cells that are pressed and have no friction; no traction depends on it.
/// solution: tractions and motion of the step. bound: of friction in each cell.
Eigen::ArrayXd complete_slip(Eigen::ArrayXd slip, const TangentialSolution& solution, const Scene& scene,
                             const Model& model, const Eigen::ArrayXd& bound, const Eigen::ArrayXd& pressure,
                             const ContactState& before);

}  // namespace slipstick::solver
