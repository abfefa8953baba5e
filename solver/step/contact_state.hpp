#pragma once

#include <Eigen/Core>
#include <optional>

#include "solver/contact/limit_load.hpp"
#include "solver/contact/normal_contact.hpp"

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

}  // namespace slipstick::solver
