#pragma once

#include <optional>
#include <string>

#include "convergence/gates/gate.hpp"

/// Gates on numbers of the literature.
namespace slipstick::convergence {

/// Value and last digit of a text such as 1.0760, 8.155e-3 or 2/3; none for another text.
std::optional<PrintedNumber> read_printed(const std::string& text);

/// Judges a gate whose bound is Published.
///   1. Our own error is `own_error` of the gate file, or the result states it next to the number
///      (`uncertainty`) or in an object around it (relative_uncertainty).
///   2. The numbers agree within half a unit of the last printed digit + argument_error + our own error.
///   3. Where our own error is larger than the other two, agreement shows nothing: the outcome is `reported`
///   if
///      the gate file says undecided, else `refused`.
/// Throws InputError where no error of ours is known.
Judgement judge_published(const Gate& gate, const Json& result);

/// How the numbers compare; none where something is wrong, or the gate has no published number.
std::optional<Comparison> comparison_of(const Judgement& judgement);

/// Our number in the unit of the publication.
struct OwnNumber {
  double value;
  double error;       ///< in the same unit
  double half_units;  ///< the error over half a unit of the last printed digit
};
/// None where the result has no number.
std::optional<OwnNumber> own_number(const Judgement& judgement);

/// The published number and ours: {text, value, half_unit, source, seen, argument_error, comparison, ours,
/// own_error, own_error_half_units, deviation, differs, undecided, not_compared}; deviation is ours minus the
/// published number, over half_unit.
Json published_json(const Judgement& judgement);

}  // namespace slipstick::convergence
