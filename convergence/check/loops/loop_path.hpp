#pragma once

#include <functional>
#include <span>
#include <vector>

namespace slipstick::convergence {

/// m at t of first loading from rest, odd; or its inverse.
using LoadingCurve = std::function<double(double)>;

/// The history before a record: the contact was rotated from rest to `turned`, against the record's first
/// direction, and back to the record's start. 0: the record starts from rest.
struct LoopStart {
  double shift = 0.0;   ///< is added to the record's rotations
  double turned = 0.0;  ///< not negative
};

/// A loop in the contact's own units: rotations as t = G a^2 phi/(mu W), moments as m = M/M_lim.
struct LoopPath {
  std::vector<double> time;  ///< from 0 to 1 over the record; by rows where no time is given
  double duration = 0.0;     ///< s; 0: no time is given
  std::vector<double> twist;
  std::vector<double> moment;
  std::vector<std::size_t> turns;  ///< rows of the reversals, between the first row and the last
  std::vector<double> turn_twist;  ///< the rotation in these rows, smoothed
  double twist_noise = 0.0;        ///< standard deviation from row to row
};

double range_of(const std::vector<double>& values);
/// The largest size of a value, 0 of none.
double largest_of(const std::vector<double>& values);

/// A straight line through points, by least squares; correlation: 1 or -1 where they lie on it.
struct LoopLine {
  double slope;
  double correlation;
};
LoopLine line_through(std::span<const double> x, std::span<const double> y);

/// Fills in turns, turn_twist and twist_noise. A reversal is larger than the noise.
void find_turns(LoopPath& path);

/// The rule for branches after a reversal.
enum class BranchRule {
  masing,        ///< a branch is the first loading, enlarged twice; a closed loop leaves no memory
  not_enlarged,  ///< a branch is the first loading in its own size
  no_slip_back,  ///< a branch has the stiffness at rest up to the largest moment so far: isotropic hardening
  elastic,       ///< moment and rotation stay on the curve of first loading
  by_moment      ///< a branch is a part of one curve, from its moment on: reversals are not remembered
};

struct BranchLaw {
  LoadingCurve loading;  ///< from rest; for by_moment from loads against the motion on
  BranchRule rule = BranchRule::masing;
  double stiffness = 0.0;     ///< of loading at rest, for no_slip_back
  LoadingCurve inverse = {};  ///< of loading, from -1 to 1, for by_moment
};

/// The law's moment in each row.
std::vector<double> follow(const LoopPath& path, const LoopStart& start, const BranchLaw& law);

/// dt/dtime in each row, from the rows next to it, or from a few more where rotations are noisy.
std::vector<double> rates(const LoopPath& path);

/// Standard deviation of the noise from row to row, from fourth differences of values that are smooth between
/// the reversals otherwise; the largest 2 % do not count.
double row_noise(const LoopPath& path, const std::vector<double>& values);

/// The root of the mean square without the largest 2 %, such as rows just after a jump.
double trimmed_mean(std::vector<double> values);

/// Areas of the closed loops, m times t. A loop runs from a reversal through the next one and back; it is
/// closed if the rotation comes back within a part of the loop's range.
std::vector<double> loop_areas(const LoopPath& path, const std::vector<double>& moment);

}  // namespace slipstick::convergence
