#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace slipstick::solver {

/// Edits (insertions, deletions, substitutions) that make one word of another: Levenshtein's distance.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The known word that is closest to a misspelt one, the first of equals; empty where none is known.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// The known key that an unknown key likely stands for: "the nearest known one is upper.radius (half of it)".
/// Both are dotted; the known ones without indices. A key in the wrong table is found by its last part, and
/// names that other programs use (E, nu, mu, diameter) by a table of such names.
std::string nearest_key(const std::string& unknown, const std::vector<std::string>& known);

}  // namespace slipstick::solver
