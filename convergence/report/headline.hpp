#pragma once

#include <string>

#include "convergence/results/result_parts.hpp"

/// What the page says first, from what the rest of it holds.
namespace slipstick::convergence {

/// The verdict and what it rests on, of a report with "mesh", "hard", "studies", "peers" and, unless they
/// were left out, "gates": `verdict` is good where every active gate holds and no hard case, study or known
/// field ends wrong, else bad; `counts` and `numbers` hold what a person remembers, `lines` says it in words,
/// in pairs of what and how.
Json headline(const Json& report);

/// Sentences on what differs from an earlier headline: none where only times do.
Json changes(const Json& now, const Json& before);

/// The headline beside an earlier one, which may be null: `since` says which page that was and `changes` what
/// is different now. What an earlier page said of its own predecessor stays where nothing is different.
Json with_changes(Json now, const Json& before);

/// For a person, ten lines at most.
std::string headline_text(const Json& headline);

}  // namespace slipstick::convergence
