#pragma once

#include <optional>
#include <string>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

struct Gate;
struct Judgement;

/// A number that somebody else published, as a gate file says it.
struct Published {
  std::string text;           ///< as printed: its digits say how far it is known
  double value = 0.0;         ///< of the text
  double half_unit = 0.0;     ///< half a unit of its last digit; of a fraction, which is exact, its rounding
  std::string source;         ///< author, year, title, table or equation, page
  std::string seen;           ///< the text in which it was looked up, where that is another
  double argument_error = 0;  ///< what the printed digits of its argument leave open
  double times = 1.0;         ///< the published number is this many times ours
  bool inverse = false;       ///< or this over ours
  std::optional<double> relative_error;  ///< of our number, where the result states none
  double own_error = 0.0;                ///< of our number, in its unit; known once it is bounded
  std::string differs;                   ///< why ours is another; empty: it agrees
  std::string not_compared;              ///< why it cannot be compared; empty: it can
};

/// Number and digits of a text such as 1.0760, 8.155e-3 or 2/3; none for another.
std::optional<Published> read_printed(const std::string& text);

/// The gate with bounds on our number: it agrees within half a unit of the last printed digit, what the
/// digits of the argument leave open, and our own error, as the result states it beside the number
/// (`uncertainty`, or relative_uncertainty in what contains it). Throws InputError where the result states
/// none.
Gate bounded_by_publication(Gate gate, const Json& result);

/// What became of it, in words; empty where something is wrong, or the gate has no published number.
std::string published_outcome(const Judgement& judgement);

/// The number beside ours, in its own unit: {text, value, half_unit, source, seen, argument_error, ours,
/// own_error, deviation, differs, not_compared}; deviation is ours minus the published number over half_unit.
Json published_json(const Judgement& judgement);

}  // namespace slipstick::convergence
