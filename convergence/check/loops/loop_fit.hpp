#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convergence/check/loops/loop_path.hpp"

namespace slipstick::convergence {

using LoopParameters = std::vector<double>;

/// Laws that differ in parameters, which are positive.
struct LoopFamily {
  std::string name;       ///< one word
  LoopParameters middle;  ///< the fit starts around them
  std::function<std::vector<double>(const LoopPath&, const LoopStart&, const LoopParameters&)> moment;
  std::function<std::string(const LoopParameters&)> sentence;  ///< what the law is in physical terms
  /// In each row: what adds to the moment in some proportion, which becomes the first parameter. Empty:
  /// nothing.
  std::vector<double> beside = {};
};

/// A law fitted to a loop, and where it lets the record start.
struct LoopHypothesis {
  std::string name;
  LoopParameters parameters;  ///< over the exact ones
  double residual = 0.0;      ///< root of the mean square distance from the loop, over its largest moment
  std::string sentence;
  double cost = 0.0;  ///< what the likeliest one has least of
  LoopStart start;
  double offset = 0.0;         ///< of the record's moments
  double part = 0.0;           ///< proportion of what stands beside the law
  std::vector<double> moment;  ///< in each row, with the offset
};

/// Whether the record begins at zero, so that it may go on from rest.
bool begins_at_zero(const LoopPath& path);

/// Rest, and other states from which the record may go on; a fit varies those.
std::vector<LoopStart> possible_starts(const LoopPath& path);

/// Fits a family to a loop: its parameters, the record's start among those given, of which the first is held,
/// the offset of its moments and, where rows are noisy, the rotations in its turns. law_error: of the laws,
/// relative.
LoopHypothesis fit_family(const LoopPath& path, double law_error, const std::vector<LoopStart>& starts,
                          const LoopFamily& family);

}  // namespace slipstick::convergence
