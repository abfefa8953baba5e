#pragma once

#include <functional>
#include <vector>

namespace slipstick::convergence {

/// A loop in the contact's own units: rotations as t = G a^2 phi/(mu W), moments as m = M/M_lim.
struct LoopPath {
  std::vector<double> time;  ///< empty: not given; else from 0 to 1 over the record
  double duration = 0.0;     ///< s
  std::vector<double> twist;
  std::vector<double> moment;
  std::vector<std::size_t> turns;  ///< rows at which the rotation turns back; the first row and the last
};

/// The rows at which a rotation turns back by more than a part of its range, which noise does not.
std::vector<std::size_t> find_turns(const std::vector<double>& twist);

/// How a law answers rotations that go to and fro: `loading` from rest, an odd function; `branch` the change
/// of the moment with that of the rotation since a reversal.
struct BranchLaw {
  std::function<double(double)> loading;
  std::function<double(double)> branch;
};

/// Masing's rule: branches are the first loading, enlarged twice.
BranchLaw masing_law(std::function<double(double)> loading);

/// The law's moment in each row. A branch that comes back to the reversal before its own goes on along the
/// branch before that; beyond the largest rotation it is first loading.
std::vector<double> follow(const LoopPath& path, const BranchLaw& law);

/// dt/dtime in each row, over the record's length, smoothed over a few rows; rows count as time where none is
/// given.
std::vector<double> rates(const LoopPath& path);

/// Areas of the closed loops, each from a reversal through the next back to it, in rows and m times t; a loop
/// is closed where the rotation comes back to its start within a part of the loop's range.
std::vector<double> loop_areas(const LoopPath& path, const std::vector<double>& moment);

}  // namespace slipstick::convergence
