#pragma once

#include <cstddef>

#include "solver/solution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {

/// How far the motions and loads at the ends of two steps lie apart.
Quantities distance(const LoadNumbers& from, const LoadNumbers& to);

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
  void add(const LoadNumbers& from, const LoadNumbers& to, const Resolution& step);
  Quantities mesh() const;
};

/// The state of a history at the end of a step. From it the next step gives the same digits as without a break.
struct HistoryState {
  std::size_t finished = 0;  ///< number of finished steps, in all cycles
  ContactState contact;
  LoadNumbers end{};  ///< in SI units; a stored state has no limit load
  OpenHistory open;
};

/// A stored state, checked against the scene that resumes from it. cells: of the scene's grid. Throws
/// std::invalid_argument for a state of another scene.
HistoryState restore_state(const HistoryState& kept, const Scene& scene, Index cells);

}  // namespace slipstick::solver
