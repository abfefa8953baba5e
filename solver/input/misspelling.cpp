#include "solver/input/misspelling.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

#include "solver/input/setting_key.hpp"

namespace slipstick::solver {
namespace {

/// Only a prefix of long words is compared: the distance costs the product of the lengths.
constexpr std::size_t kMaxCompared = 100;

/// A name that other programs and books use, and the part of our keys that means the same.
struct OtherName {
  std::string_view other;
  std::string_view ours;
  std::string_view note = {};  ///< how the value changes
};
constexpr std::string_view kTwiceOnePlusNu = "2 (1 + poisson_ratio) times it";
constexpr std::string_view kInRad = "in rad, or as a text, \"1 deg\"";
constexpr std::string_view kForceIsTangential = "load.force is tangential, [F1, F2]";
constexpr OtherName kOtherNames[]{{"E", "young_modulus"},
                                  {"young", "young_modulus"},
                                  {"youngs_modulus", "young_modulus"},
                                  {"elastic_modulus", "young_modulus"},
                                  {"modulus", "young_modulus"},
                                  {"nu", "poisson_ratio"},
                                  {"poisson", "poisson_ratio"},
                                  {"poissons_ratio", "poisson_ratio"},
                                  {"G", "young_modulus", kTwiceOnePlusNu},
                                  {"shear_modulus", "young_modulus", kTwiceOnePlusNu},
                                  {"mu", "friction"},
                                  {"cof", "friction"},
                                  {"friction_coefficient", "friction"},
                                  {"R", "radius"},
                                  {"diameter", "radius", "half of it"},
                                  {"load", "normal"},
                                  {"normal_load", "normal"},
                                  {"normal_force", "normal"},
                                  {"weight", "normal"},
                                  {"force", "normal", kForceIsTangential},
                                  {"torque", "moment"},
                                  {"twist_angle", "twist"},
                                  {"rotation", "twist"},
                                  {"twist_deg", "twist", kInRad},
                                  {"coating", "layer", "in [upper] or [lower]"},
                                  {"resolution", "cells"},
                                  {"yield", "yield_stress"},
                                  {"yield_strength", "yield_stress"}};

/// The other name that a part of a key is; null: none.
const OtherName* find_other_name(std::string_view part) {
  const auto* const found = std::ranges::find(kOtherNames, part, &OtherName::other);
  return found == std::end(kOtherNames) ? nullptr : found;
}

std::vector<std::string> key_parts(const std::string& key) {
  std::vector<std::string> parts{""};
  for (const char c : key) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::pair<std::string_view, std::string_view> parent_and_last(std::string_view key) {
  const std::size_t dot = key.rfind('.');
  if (dot == std::string_view::npos) return {"", key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

/// Edits between keys, in the whole path or in the last part, where another table counts as one edit.
std::size_t key_distance(const std::string& unknown, const std::string& known) {
  const auto [parent, last] = parent_and_last(unknown);
  const auto [other_parent, other_last] = parent_and_last(known);
  return std::min(edit_distance(unknown, known), edit_distance(std::string(last), std::string(other_last)) +
                                                     (parent == other_parent ? 0 : 1));
}

/// A known key with the indices of the unknown one, as far as they are in the same tables.
std::string with_indices(const std::string& known, const std::string& unknown) {
  std::vector<std::string> parts = key_parts(known);
  const std::vector<std::string> indexed = key_parts(unknown);
  for (std::size_t i = 0; i < std::min(parts.size(), indexed.size()); ++i) {
    if (without_indices(indexed[i]) != parts[i]) break;
    parts[i] = indexed[i];
  }
  return fmt::format("{}", fmt::join(parts, "."));
}

}  // namespace

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  const std::string compared = word.substr(0, kMaxCompared);
  const auto nearest = std::ranges::min_element(
      known, {}, [&](const std::string& each) { return edit_distance(compared, each); });
  return nearest == known.end() ? "" : *nearest;
}

std::string nearest_key(const std::string& unknown, const std::vector<std::string>& known) {
  std::vector<std::string> parts = key_parts(without_indices(unknown.substr(0, kMaxCompared)));
  std::string_view note;
  for (std::string& part : parts) {
    const OtherName* const name = find_other_name(part);
    note = name != nullptr ? name->note : "";
    if (name != nullptr) part = name->ours;
  }
  const std::string meant = fmt::format("{}", fmt::join(parts, "."));
  const auto nearest = std::ranges::min_element(known, {}, [&](const std::string& each) {
    const bool elsewhere = !meant.starts_with(parent_and_last(each).first);
    return std::tuple(key_distance(meant, each), elsewhere, edit_distance(meant, each));
  });
  if (nearest == known.end()) return "no key is known";
  const bool on_top = nearest->find('.') == std::string::npos && parts.size() > 1;
  if (on_top) note = "above all tables";
  return fmt::format("the nearest known one is {}{}", with_indices(*nearest, unknown),
                     note.empty() ? "" : fmt::format(" ({})", note));
}

}  // namespace slipstick::solver
