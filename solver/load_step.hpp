#pragma once

#include <Eigen/Core>

#include "solver/contact/limit_load.hpp"
#include "solver/contact/tangential_problem.hpp"
#include "solver/model.hpp"

namespace slipstick::solver {

/// What a step starts from and ends with, in the model's units.
struct ContactState {
  Eigen::ArrayXd pressure;  ///< empty: the bodies have not touched yet
  Eigen::ArrayXd traction;  ///< 2*cells; empty likewise
  /// 2*cells, of each cell since it last stuck or turned back; empty where the contact has just grown.
  Eigen::ArrayXd slip;
  RigidMotion motion;  ///< since the first step began
  /// The largest q.Kq/2 so far, as far as the friction bounds have been able to hold it since; over the cell
  /// area. What a step's certificate is relative to where it leaves less.
  double energy = 0.0;
};

/// A step's tangential problem, and what its contact can carry.
struct LoadStep {
  TangentialProblem problem;
  double moment_limit;  ///< over the cell area, without force
  LimitLoad limit;      ///< of the loads that the step imposes

  bool carried() const { return limit.factor > 1.0; }
};

/// The change that a step of a scene brings to a contact under its pressure, on the model's grid.
LoadStep load_step(const Scene& scene, const Model& model, const Step& step, const Eigen::ArrayXd& pressure,
                   const ContactState& before);

/// Throws InputError for gross slip, with what the contact carries and how it would slide.
void require_carried(const Scene& scene, const Model& model, const Step& step, const LoadStep& loads);
}  // namespace slipstick::solver
