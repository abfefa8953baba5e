#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Which of many ways to an answer are worth taking: by the seconds they take and the error they leave.
namespace slipstick::bench {

/// One way: what was chosen (key and word), its seconds with their interval, its error. An error that is not
/// a number is never as good as another.
struct Way {
  std::map<std::string, std::string> choice;
  double cells = 0.0;
  double seconds = 0.0;  ///< median
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;
};

/// Errors this near count as the same: those of one mesh differ by as much from grid to grid.
inline constexpr double kSameError = 1.05;

/// Indices of the ways that no other way beats, quickest first. A way beats another if it is at least as
/// quick and as good, and better in one of the two; of equal ways none beats another.
std::vector<std::size_t> pareto_front(const std::vector<Way>& ways);

/// The quickest way with at most this error; none if no way is as good.
std::optional<std::size_t> quickest_to(const std::vector<Way>& ways, double error);

/// The key of a choice that each way takes as it needs, as it does the mesh.
inline constexpr const char* kTolerance = "tolerance";

/// A word of a choice that is never worth taking, or not from some mesh on: for each way with it there is a
/// surely quicker one (intervals apart), at least as good up to kSameError, that differs in this key, the
/// mesh and the tolerance alone.
struct DominatedChoice {
  std::string key;
  std::string word;
  std::string by;             ///< the word that beats it most often
  double from_cells = 0.0;    ///< smallest mesh from which it is
  bool everywhere = false;    ///< on all meshes that it was tried on
  double times_slower = 0.0;  ///< median over its ways from there on, against the quickest that is as good
  double least = 0.0;
  double most = 0.0;
  std::size_t ways = 0;  ///< that it was determined from
};

/// For each key and word, in their order.
std::vector<DominatedChoice> dominated_choices(const std::vector<Way>& ways);

}  // namespace slipstick::bench
