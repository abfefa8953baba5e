#include "bench/plane/plane_design.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace slipstick::bench {
namespace {

using solver::Index;
using Cells = std::vector<Index>;
using Tolerances = std::vector<double>;

/// The moment ratio at which every choice is tried.
constexpr double kMainRatio = 0.9;
/// Tolerances at which choices other than method and mesh are tried: where the mesh's error is reached for
/// the twist, and the program's default.
const Tolerances kOneAtATime{1e-4, 1e-8};

class Design {
 public:
  void add(const PlaneChoice& choice) {
    if (std::find(choices_.begin(), choices_.end(), choice) == choices_.end()) choices_.push_back(choice);
  }

  void add(PlaneChoice choice, const Cells& meshes, const Tolerances& tolerances) {
    for (const Index cells : meshes) {
      for (const double tolerance : tolerances) {
        choice.cells = cells;
        choice.tolerance = tolerance;
        add(choice);
      }
    }
  }

  std::vector<PlaneChoice> take() { return std::move(choices_); }

 private:
  std::vector<PlaneChoice> choices_;
};

/// Direct and dense summation cost the fourth power of the cells along a side: beyond these a solve takes
/// seconds, or gigabytes.
void add_operators(Design& design, bool quick) {
  design.add({.op = "direct", .model = "full"}, quick ? Cells{16, 32} : Cells{16, 32, 64}, kOneAtATime);
  design.add({.op = "dense", .model = "full"}, quick ? Cells{16} : Cells{16, 32}, kOneAtATime);
}

void add_one_at_a_time(Design& design, bool quick) {
  const Cells meshes = quick ? Cells{32, 64, 128} : Cells{16, 32, 64, 128, 256};
  const std::vector<PlaneChoice> choices{
      {.model = "full"}, {.pressure = "hertz"}, {.pressure = "hertz_averaged"}};
  for (const PlaneChoice& choice : choices) {
    design.add(choice, meshes, kOneAtATime);
    if (!quick) design.add(choice, {512}, {1e-6});
  }
  add_operators(design, quick);
}

void add_methods(Design& design, bool quick) {
  for (const char* method : {"paper", "projected_gradient"}) {
    if (quick) {
      design.add({.method = method}, {16, 32, 64, 128}, {1e-2, 1e-4, 1e-6});
      continue;
    }
    design.add({.method = method}, {16, 32, 64, 128}, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8});
    design.add({.method = method}, {256}, {1e-3, 1e-4, 1e-5, 1e-6});
    design.add({.method = method}, {512}, {1e-4});
  }
}

}  // namespace

std::string choice_words(const PlaneChoice& choice, const char* separator) {
  std::vector<std::string> words;
  for (const ChoiceKey& key : kChoiceKeys) words.push_back(choice.*key.word);
  return fmt::format("{}", fmt::join(words, separator));
}

std::vector<std::string> overrides(const PlaneChoice& choice) {
  std::vector<std::string> all{fmt::format("grid.cells=[{0}, {0}]", choice.cells),
                               fmt::format("solver.tolerance={}", choice.tolerance), "solver.threads=1"};
  for (const ChoiceKey& key : kChoiceKeys)
    all.push_back(fmt::format("{}=\"{}\"", key.scene_key, choice.*key.word));
  return all;
}

std::vector<double> plane_moment_ratios(bool quick) {
  return quick ? std::vector<double>{kMainRatio} : std::vector<double>{0.5, 0.9, 0.99};
}

std::vector<PlaneChoice> plane_design(double moment_ratio, bool quick) {
  Design design;
  const bool all = moment_ratio == kMainRatio && !quick;
  if (quick) {
    design.add({}, {16, 32, 64, 128, 256}, {1e-2, 1e-4, 1e-6, 1e-8});
  } else {
    design.add({}, {16, 24, 32, 48, 64, 96, 128, 192}, {1e-2, 1e-3, 1e-4, 1e-6, 1e-8});
    design.add({}, {256}, {1e-3, 1e-4, 1e-6, 1e-8});
    design.add({}, {512}, {1e-4, 1e-6});
    design.add({}, {1024}, {1e-6});
  }
  if (all) design.add({}, {16, 24, 32, 48, 64, 96, 128}, {1e-5, 1e-10});
  if (all) design.add({}, {512}, {1e-3, 1e-8});
  if (moment_ratio == kMainRatio) {
    add_methods(design, quick);
    add_one_at_a_time(design, quick);
  } else {
    design.add({.method = "paper"}, {32, 64, 128}, {1e-3, 1e-4, 1e-5, 1e-6});
    design.add({.method = "projected_gradient"}, {32, 64, 128}, {1e-2, 1e-4, 1e-6});
  }
  return design.take();
}

}  // namespace slipstick::bench
