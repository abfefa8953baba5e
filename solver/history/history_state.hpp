#pragma once

#include <array>
#include <cstddef>

#include "solver/solution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {

/// Motion since the first step began, and loads, at the end of a step; in SI units.
struct StepEnd {
  double twist = 0.0;
  std::array<double, 2> displacement{};
  double moment = 0.0;
  std::array<double, 2> force{};
  double moment_limit = 0.0;
};
StepEnd end_of(const LoadNumbers& numbers);

/// How far two ends lie apart.
Quantities distance(const StepEnd& from, const StepEnd& to);

/// The mesh error of the steps so far. Absolute errors of steps add up. A larger loop erases a smaller one
/// from the contact's memory, so that the sum is bounded by twice the largest size that was reached, times
/// the relative error of the worst step.
struct OpenHistory {
  Quantities sum;
  Quantities largest;
  double worst = 0.0;
  /// The same of Resolution::open. A step that turns on in the direction of the last one adds the increase.
  Quantities small_stick;
  Quantities largest_small_stick;
  Quantities last_small_stick;  ///< Resolution::open of the last step
  double last_twist = 0.0;      ///< twist of the last step

  /// A step from one end to the next.
  void add(const StepEnd& from, const StepEnd& to, const Resolution& step);
  Quantities mesh() const;
};

/// The state of a history at the end of a step. From it the next step gives the same digits as without a break.
struct HistoryState {
  std::size_t finished = 0;  ///< number of finished steps, in all cycles
  ContactState contact;
  StepEnd end;
  OpenHistory open;
};

/// A stored state, checked against the scene that resumes from it. cells: of the scene's grid. Throws
/// std::invalid_argument for a state of another scene.
HistoryState restore_state(const HistoryState& kept, const Scene& scene, Index cells);

}  // namespace slipstick::solver
