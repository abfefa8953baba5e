#pragma once

#include <string>

#include "convergence/results/result_parts.hpp"

/// What the page says first, beside what the page before it said.
namespace slipstick::convergence {

/// Sentences on what differs from an earlier headline: none where only times do.
Json changes(const Json& now, const Json& before);

/// The headline beside an earlier one, which may be null: `since` says which page that was and `changes` what
/// is different now. What an earlier page said of its own predecessor stays where nothing is different.
Json with_changes(Json now, const Json& before);

/// For a person, ten lines at most.
std::string headline_text(const Json& headline);

}  // namespace slipstick::convergence
