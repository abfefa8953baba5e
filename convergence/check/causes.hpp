#pragma once

#include <optional>
#include <vector>

#include "convergence/check/diagnosis.hpp"
#include "convergence/check/verdict.hpp"

namespace slipstick::convergence {

/// The likely causes of a field's errors.
struct Explanation {
  std::optional<Diagnosis> diagnosis;  ///< of a field whose tractions, motion or law of friction are wrong
  std::vector<Cause> causes;           ///< mistakes without which the field would be good
};

/// Looks for causes in this order, and stops at the first that explains the field:
///
///  1. A wrong pressure: an infinite value that was sampled, rows that are missing, another scene's pressure
///     (each with one mistake in bodies or layers, solved on the field's cells).
///  2. A smaller load than the scene's: the tractions of a step before.
///  3. A wrong twist of right tractions: units, sign, compliance.
///  4. Another friction than the scene's, a wrong kernel, directions that slipping cells keep: diagnose().
Explanation explain(const Examination& examination, const Verdict& verdict);

}  // namespace slipstick::convergence
