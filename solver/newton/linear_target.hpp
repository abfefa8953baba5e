#pragma once

#include <algorithm>
#include <cmath>

#include "solver/grid/grid.hpp"

/// How far the linear problem of a Newton step is worth solving.
namespace slipstick::solver {

struct LinearTarget {
  double reduction;  ///< of the residual
  int max_iterations;
};

/// The residual falls by this while states change, and by what the tolerance needs once they stand, as this
/// part of it.
inline constexpr double kLooseReduction = 0.1;
inline constexpr double kTightReduction = 1e-4;
inline constexpr double kPartOfWanted = 0.3;
/// Of pressures, whose states change all over a rough surface: more is lost on a state that will not last.
inline constexpr double kLooseReductionOfPressure = 0.2;
/// Times the root of the part of the free cells that have changed: as far as a pressure's state can be
/// trusted.
inline constexpr double kDistrust = 3.0;
inline constexpr int kInnerIterations = 40;

inline int inner_iterations(long applications_left) {
  return static_cast<int>(std::min<long>(applications_left, kInnerIterations));
}

/// wanted: the part that is to be left of the gap; applications_left: one at least; changed: cells whose
/// state did.
inline LinearTarget target_of_tractions(double wanted, long applications_left, Index changed) {
  const double reduction = changed > 0 ? kLooseReduction : kPartOfWanted * wanted;
  return {std::clamp(reduction, kTightReduction, kLooseReduction), inner_iterations(applications_left)};
}

/// free: cells that carry pressure.
inline LinearTarget target_of_pressure(double wanted, long applications_left, Index changed, Index free) {
  const double part = static_cast<double>(changed) / static_cast<double>(std::max<Index>(free, 1));
  const double reduction = std::max(kPartOfWanted * wanted, kDistrust * std::sqrt(part));
  return {std::clamp(reduction, kTightReduction, kLooseReductionOfPressure),
          inner_iterations(applications_left)};
}

}  // namespace slipstick::solver
