#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convergence/check/loops/loop_contact.hpp"
#include "convergence/check/loops/loop_path.hpp"

namespace slipstick::convergence {

using LoopParameters = std::vector<double>;

/// A family of laws with positive parameters.
struct LoopFamily {
  std::string name;       ///< one word
  LoopParameters middle;  ///< the fit starts around them
  std::function<std::vector<double>(const LoopPath&, const LoopStart&, const LoopParameters&)> moment;
  std::function<std::string(const LoopParameters&)> sentence;  ///< the law in physical terms
  /// For each row a term that is added to the moment in some proportion, the first parameter; empty: none.
  std::vector<double> beside = {};
};

/// A law fitted to a loop, with the start that it fits best.
struct LoopHypothesis {
  std::string name;
  LoopParameters parameters;  ///< over the exact ones
  double residual = 0.0;      ///< root mean square distance from the loop, over its largest moment
  std::string sentence;
  double cost = 0.0;  ///< the likeliest law has the lowest
  LoopStart start;
  double offset = 0.0;         ///< of the record's moments
  double part = 0.0;           ///< proportion of the field that LoopFamily::beside adds
  std::vector<double> moment;  ///< in each row, with the offset
};

/// Whether the record begins at zero, where it may start from rest.
bool begins_at_zero(const LoopPath& path);

/// Rest, and other states from which the record may start; a fit varies the others.
std::vector<LoopStart> possible_starts(const LoopPath& path);

/// Fits a family to a loop by its parameters, the record's start (the first of the given ones is fixed, the
/// others are varied), the offset of its moments and, where rows are noisy, the rotations at its reversals.
/// law_error: relative error of the laws.
LoopHypothesis fit_family(const LoopPath& path, double law_error, const std::vector<LoopStart>& starts,
                          const LoopFamily& family);

// ---------------------------------------------------------------- the laws that are tried (loop_laws.cpp)

/// The exact law, from the one of these starts that brings it closest to the loop.
LoopHypothesis fit_exact_law(const LoopPath& path, const LoopContact& contact,
                             const std::vector<LoopStart>& starts);

/// The laws that simulators use instead of the exact one, each with its best parameters.
std::vector<LoopHypothesis> fit_wrong_laws(const LoopPath& path, const LoopContact& contact);

}  // namespace slipstick::convergence
