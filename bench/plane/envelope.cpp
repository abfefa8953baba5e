#include "bench/plane/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bench/timing/median.hpp"

namespace slipstick::bench {
namespace {

bool is_number(const Way& way) { return std::isfinite(way.seconds) && std::isfinite(way.error); }

/// At least as quick and as good, and better in one of the two.
bool beats(const Way& a, const Way& b) {
  return a.seconds <= b.seconds && a.error <= b.error && (a.seconds < b.seconds || a.error < b.error);
}

/// A way with a word, beside the quickest of the other words' ways that is as good.
struct BesideBest {
  double cells;
  bool surely_slower;
  double times_slower;
  std::string by;
};

/// Whether two ways differ in this key alone, and in the mesh and the tolerance, which each takes as it
/// needs.
bool rivals(const Way& a, const Way& b, const std::string& key) {
  for (const auto& [other, word] : a.choice) {
    const bool free = other == key || other == kTolerance;
    if (!free && b.choice.at(other) != word) return false;
  }
  return a.choice.at(key) != b.choice.at(key);
}

std::optional<BesideBest> beside_best(const std::vector<Way>& ways, const Way& way, const std::string& key) {
  const Way* best = nullptr;
  for (const Way& other : ways) {
    if (!is_number(other) || !rivals(way, other, key) || !(other.error <= kSameError * way.error)) continue;
    if (best == nullptr || other.seconds < best->seconds) best = &other;
  }
  if (best == nullptr) return std::nullopt;
  return BesideBest{way.cells, best->high < way.low, way.seconds / best->seconds, best->choice.at(key)};
}

std::string most_frequent(const std::vector<BesideBest>& all) {
  std::map<std::string, int> count;
  for (const BesideBest& one : all) ++count[one.by];
  return std::ranges::max_element(count, {}, &decltype(count)::value_type::second)->first;
}

DominatedChoice summary(const std::string& key, const std::string& word,
                        const std::vector<BesideBest>& lost) {
  DominatedChoice found{.key = key, .word = word, .by = most_frequent(lost)};
  std::vector<double> ratios;
  found.from_cells = std::numeric_limits<double>::infinity();
  for (const BesideBest& one : lost) {
    ratios.push_back(one.times_slower);
    found.from_cells = std::min(found.from_cells, one.cells);
  }
  found.times_slower = median(ratios);
  found.least = std::ranges::min(ratios);
  found.most = std::ranges::max(ratios);
  found.ways = lost.size();
  return found;
}

/// The ways with a word from the smallest mesh on from which all are beaten.
std::optional<DominatedChoice> dominated(const std::vector<Way>& ways, const std::string& key,
                                         const std::string& word) {
  double last_won = 0.0;  // cells of the finest mesh on which it is worth taking
  std::vector<BesideBest> lost;
  for (const Way& way : ways) {
    if (!is_number(way) || way.choice.at(key) != word) continue;
    const std::optional<BesideBest> found = beside_best(ways, way, key);
    if (found && found->surely_slower) {
      lost.push_back(*found);
    } else {
      last_won = std::max(last_won, way.cells);
    }
  }
  std::erase_if(lost, [&](const BesideBest& one) { return one.cells <= last_won; });
  if (lost.empty()) return std::nullopt;
  DominatedChoice choice = summary(key, word, lost);
  choice.everywhere = last_won == 0.0;
  return choice;
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<Way>& ways) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const auto beats_it = [&](const Way& other) { return is_number(other) && beats(other, ways[i]); };
    if (is_number(ways[i]) && std::ranges::none_of(ways, beats_it)) front.push_back(i);
  }
  std::ranges::stable_sort(front, {}, [&](std::size_t way) { return ways[way].seconds; });
  return front;
}

std::optional<std::size_t> quickest_to(const std::vector<Way>& ways, double error) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!is_number(ways[i]) || !(ways[i].error <= error)) continue;
    if (!best || ways[i].seconds < ways[*best].seconds) best = i;
  }
  return best;
}

std::vector<DominatedChoice> dominated_choices(const std::vector<Way>& ways) {
  std::map<std::string, std::set<std::string>> words;
  for (const Way& way : ways) {
    for (const auto& [key, word] : way.choice) words[key].insert(word);
  }
  std::vector<DominatedChoice> all;
  for (const auto& [key, of_key] : words) {
    for (const std::string& word : of_key) {
      if (const auto found = dominated(ways, key, word)) all.push_back(*found);
    }
  }
  return all;
}

}  // namespace slipstick::bench
