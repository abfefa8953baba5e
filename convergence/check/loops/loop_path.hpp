#pragma once

#include <functional>
#include <span>
#include <vector>

namespace slipstick::convergence {

/// What happened before a record: the contact was turned to `turned` from rest, against the direction in
/// which the record goes first, and back to where the record starts. 0: the record goes on from rest.
struct LoopStart {
  double shift = 0.0;   ///< what is added to the record's rotations
  double turned = 0.0;  ///< not negative
};

/// A loop in the contact's own units: rotations as t = G a^2 phi/(mu W), moments as m = M/M_lim.
struct LoopPath {
  std::vector<double> time;  ///< from 0 to 1 over the record; where none is given, the rows'
  double duration = 0.0;     ///< s; 0: no time is given
  std::vector<double> twist;
  std::vector<double> moment;
  std::vector<std::size_t> turns;  ///< rows at which the rotation turns back; the first row and the last
  std::vector<double> turn_twist;  ///< the rotation in these rows, less its noise
  double twist_noise = 0.0;        ///< standard deviation from row to row
};

double range_of(const std::vector<double>& values);

/// A straight line through points, by least squares; correlation: 1 or -1 where they lie on it.
struct LoopLine {
  double slope;
  double correlation;
};
LoopLine line_through(std::span<const double> x, std::span<const double> y);

/// Fills in turns, turn_twist and twist_noise. A rotation turns back where it does by more than a part of its
/// range, which noise does not.
void find_turns(LoopPath& path);

/// How a contact answers rotations that go to and fro.
enum class BranchRule {
  masing,        ///< branches are the first loading, enlarged twice; a closed loop is forgotten
  not_enlarged,  ///< branches are the first loading
  no_slip_back,  ///< a branch has the stiffness at rest up to the largest moment so far: isotropic hardening
  elastic        ///< there is the first loading alone, both ways
};

struct BranchLaw {
  std::function<double(double)> loading;  ///< from rest, odd
  BranchRule rule = BranchRule::masing;
  double stiffness = 0.0;  ///< of loading at rest, for no_slip_back
};

/// The law's moment in each row.
std::vector<double> follow(const LoopPath& path, const LoopStart& start, const BranchLaw& law);

/// dt/dtime in each row, over the record's length: over the rows next to it, or a few more where rotations
/// are noisy.
std::vector<double> rates(const LoopPath& path);

/// Standard deviation from row to row of values that are smooth between the turns but for their noise, from
/// fourth differences; the largest 2 % do not count.
double row_noise(const LoopPath& path, const std::vector<double>& values);

/// The root of the mean square without the largest 2 %, such as rows just after a jump.
double trimmed_mean(std::vector<double> values);

/// Areas of the closed loops, each from a reversal through the next back to it, in rows and m times t; a loop
/// is closed where the rotation comes back to its start within a part of the loop's range.
std::vector<double> loop_areas(const LoopPath& path, const std::vector<double>& moment);

}  // namespace slipstick::convergence
