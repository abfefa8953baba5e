#include "solver/input/misspelling.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include "solver/input/setting_key.hpp"

namespace slipstick::solver {
namespace {

/// Only a prefix of long words is compared: the distance costs the product of the lengths.
constexpr std::size_t kMaxCompared = 100;

/// The parts of our keys, and the names that other programs and books use for the same.
constexpr struct {
  std::string_view ours;
  std::array<std::string_view, 7> others;
} kOtherNames[]{{"young_modulus", {"E", "young", "youngs_modulus", "elastic_modulus", "modulus", "G", "shear_modulus"}},
                {"poisson_ratio", {"nu", "poisson", "poissons_ratio"}},
                {"friction", {"mu", "cof", "friction_coefficient"}},
                {"radius", {"R", "diameter"}},
                {"normal", {"load", "normal_load", "normal_force", "force", "weight"}},
                {"moment", {"torque"}},
                {"twist", {"twist_angle", "rotation", "twist_deg"}},
                {"layer", {"coating"}},
                {"cells", {"resolution", "n"}},
                {"yield_stress", {"yield", "yield_strength"}},
                {"below", {"max", "limit", "bound"}},
                {"above", {"min"}}};

/// How the value or the place differs.
std::string_view note_on(std::string_view other) {
  if (other == "diameter") return "half of it";
  if (other == "G" || other == "shear_modulus") return "2 (1 + poisson_ratio) times it";
  if (other == "twist_deg") return "in rad, or as a text, \"1 deg\"";
  if (other == "force") return "load.force is tangential, [F1, F2]";
  return other == "coating" ? "in [upper] or [lower]" : "";
}

/// The part of our keys that a part of a key means; itself where the table does not have it.
std::string meant_by(const std::string& part) {
  const auto* const found =
      std::ranges::find_if(kOtherNames, [&](const auto& each) { return std::ranges::count(each.others, part) > 0; });
  return part.empty() || found == std::end(kOtherNames) ? part : std::string(found->ours);
}

std::size_t last_part(const std::string& key) { return key.rfind('.') + 1; }

/// Edits between keys, in the whole path or in the last part, where another table counts as one edit.
std::size_t key_distance(const std::string& a, const std::string& b) {
  const std::size_t last = edit_distance(a.substr(last_part(a)), b.substr(last_part(b)));
  const bool same_table = a.substr(0, last_part(a)) == b.substr(0, last_part(b));
  return std::min(edit_distance(a, b), last + (same_table ? 0 : 1));
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
  const auto nearest =
      std::ranges::min_element(known, {}, [&](const std::string& each) { return edit_distance(compared, each); });
  return nearest == known.end() ? "" : *nearest;
}

std::string nearest_key(const std::string& unknown, const std::vector<std::string>& known) {
  std::istringstream parts(unknown.substr(0, kMaxCompared));
  std::string meant;
  std::string part;
  while (std::getline(parts, part, '.')) meant += (meant.empty() ? "" : ".") + meant_by(without_indices(part));
  const auto nearest = std::ranges::min_element(known, {}, [&](const std::string& each) {
    const bool elsewhere = !meant.starts_with(each.substr(0, last_part(each)));
    return std::tuple(key_distance(meant, each), elsewhere, edit_distance(meant, each));
  });
  if (nearest == known.end()) return "no key is known";
  const bool on_top = last_part(*nearest) == 0 && last_part(unknown) != 0;
  const std::string_view note = on_top ? "above all tables" : note_on(without_indices(part));
  // The indices of the tables in which both are.
  std::string indexed = *nearest;
  for (std::size_t dot = unknown.rfind('.'); dot != std::string::npos && dot > 0; dot = unknown.rfind('.', dot - 1)) {
    const std::string table = without_indices(unknown.substr(0, dot));
    if (!nearest->starts_with(table + ".")) continue;
    indexed.replace(0, table.size(), unknown, 0, dot);
    break;
  }
  return fmt::format("the nearest known one is {}{}", indexed, note.empty() ? "" : fmt::format(" ({})", note));
}

}  // namespace slipstick::solver
