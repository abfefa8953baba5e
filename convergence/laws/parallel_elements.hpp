#pragma once

#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/torsion.hpp"

/// Laws of straight lines: tables with linear interpolation, and springs with friction in parallel.
/// Dimensionless as twist_law.hpp; errors are of m = M/M_lim, absolute.
namespace slipstick::convergence {

/// States on the exact curve, from rest to where 1 - m is the error, straight lines between them, and the
/// last moment beyond.
struct StateTable {
  std::vector<analytic::TorsionState> rows;
  double error;  ///< the largest
};

/// A spring in series with a slider, as Jenkins and Iwan have them.
struct JenkinsElement {
  double stiffness;  ///< m over t
  double slip;       ///< m at which it slips
};

/// Jenkins elements side by side. Together they stick and slip as the contact does, Masing's rule included;
/// their slip moments sum up to 1, the exact limit.
///
/// After any rotations the error is e(x_0) - 2 e(x_1) + 2 e(x_2) - ... with e that of first loading, x_0 the
/// largest rotation and x_1 > x_2 > ... half the ranges of the branches still open. As x_0 >= x_1, it is a
/// sum of differences of e over intervals side by side: at most the total variation of e, which reversals at
/// its extremes reach.
struct ParallelElements {
  std::vector<JenkinsElement> elements;  ///< the first to slip first
  double error;          ///< the largest on first loading; on loops between t and -t three times that
  double history_error;  ///< the largest after any rotations: the total variation of that on first loading

  double moment_ratio_at(double twist) const;  ///< on first loading
};

/// The range of errors of m, and of numbers of elements, that may be asked for.
inline constexpr double kMinLineError = 1e-7;
inline constexpr double kMaxLineError = 0.5;
inline constexpr int kMaxElements = 200;

/// As few rows as keep the error. Throws std::domain_error for one out of range.
StateTable tabulate(const analytic::Profile& profile, double error);

/// Rows at equal steps of the rotation, for readers that draw cubic splines through them or step evenly: with
/// either, and with straight lines, the error is kept. Throws std::domain_error as tabulate().
StateTable tabulate_evenly(const analytic::Profile& profile, double error);

/// As few elements as keep the error, from 1e-5 on. Throws std::domain_error for one out of range.
ParallelElements parallel_elements(const analytic::Profile& profile, double error);

/// So many elements at most (1 to kMaxElements, or std::domain_error), with the least error.
ParallelElements parallel_elements(const analytic::Profile& profile, int count);

}  // namespace slipstick::convergence
