#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/contact/limit_load.hpp"
#include "solver/solution.hpp"

/// The state of the contact that one step leaves to the next.
namespace slipstick::solver {

/// Motion since the first step began, and loads, at the end of a step; in SI units.
struct StepEnd {
  double twist = 0.0;
  std::array<double, 2> displacement{};
  double moment = 0.0;
  std::array<double, 2> force{};
  double moment_limit = 0.0;
};
StepEnd end_of(const Solution& solution);

/// How far two ends lie apart.
Quantities distance(const StepEnd& from, const StepEnd& to);

/// The mesh error of the steps so far. Errors of steps add up, whatever their signs. But a contact forgets a
/// loop once a larger one closes: the sum is bounded by twice the largest size that was reached, at the
/// relative error of the worst step.
struct OpenHistory {
  Quantities sum;
  Quantities largest;
  double worst = 0.0;
  Quantities small_stick;          ///< likewise of Resolution::open, of which a step that goes on adds
  Quantities largest_small_stick;  ///< what is new
  Quantities last_small_stick;
  double last_twist = 0.0;  ///< of the last step alone

  /// A step from one end to the next.
  void add(const StepEnd& from, const StepEnd& to, const Resolution& step);
  Quantities mesh() const;
};

/// The contact at the start or the end of a step, in the model's units.
struct ContactState {
  Eigen::ArrayXd pressure;  ///< empty: the bodies have not touched yet
  Eigen::ArrayXd traction;  ///< 2*cells; empty likewise
  /// 2*cells, of each cell since it last stuck or turned back; empty where the contact has just grown.
  Eigen::ArrayXd slip;
  RigidMotion motion;  ///< since the first step began
  /// The largest q.Kq/2 so far, as far as the friction bounds have been able to hold it since; over the cell
  /// area. What a step's certificate is relative to where it leaves less.
  double energy = 0.0;
  StepEnd end;
  OpenHistory open;
};

}  // namespace slipstick::solver
