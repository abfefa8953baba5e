#include "bench/plane/plane_design.hpp"

#include <fmt/ranges.h>

#include <algorithm>

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

using Design = std::vector<PlaneChoice>;

/// The choice on each mesh to each tolerance, unless it is there.
void add(Design& design, PlaneChoice choice, const Cells& meshes, const Tolerances& tolerances) {
  for (const Index cells : meshes) {
    for (const double tolerance : tolerances) {
      choice.cells = cells;
      choice.tolerance = tolerance;
      if (std::ranges::find(design, choice) == design.end()) design.push_back(choice);
    }
  }
}

void add_one_at_a_time(Design& design, bool quick) {
  const Cells meshes = quick ? Cells{32, 64, 128} : Cells{16, 32, 64, 128, 256};
  const std::vector<PlaneChoice> choices{
      {.model = "full"}, {.pressure = "hertz"}, {.pressure = "hertz_averaged"}};
  for (const PlaneChoice& choice : choices) {
    add(design, choice, meshes, kOneAtATime);
    if (!quick) add(design, choice, {512}, {1e-6});
  }
  // Direct and dense summation cost the fourth power of the cells along a side: beyond these a solve takes
  // seconds, or gigabytes.
  add(design, {.op = "direct", .model = "full"}, quick ? Cells{16, 32} : Cells{16, 32, 64}, kOneAtATime);
  add(design, {.op = "dense", .model = "full"}, quick ? Cells{16} : Cells{16, 32}, kOneAtATime);
}

void add_methods(Design& design, bool quick) {
  for (const char* method : {"paper", "projected_gradient"}) {
    if (quick) {
      add(design, {.method = method}, {16, 32, 64, 128}, {1e-2, 1e-4, 1e-6});
      continue;
    }
    add(design, {.method = method}, {16, 32, 64, 128}, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8});
    add(design, {.method = method}, {256}, {1e-3, 1e-4, 1e-5, 1e-6});
    add(design, {.method = method}, {512}, {1e-4});
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
    add(design, {}, {16, 32, 64, 128, 256}, {1e-2, 1e-4, 1e-6, 1e-8});
  } else {
    add(design, {}, {16, 24, 32, 48, 64, 96, 128, 192}, {1e-2, 1e-3, 1e-4, 1e-6, 1e-8});
    add(design, {}, {256}, {1e-3, 1e-4, 1e-6, 1e-8});
    add(design, {}, {512}, {1e-4, 1e-6});
    add(design, {}, {1024}, {1e-6});
  }
  if (all) add(design, {}, {16, 24, 32, 48, 64, 96, 128}, {1e-5, 1e-10});
  if (all) add(design, {}, {512}, {1e-3, 1e-8});
  if (moment_ratio == kMainRatio) {
    add_methods(design, quick);
    add_one_at_a_time(design, quick);
  } else {
    add(design, {.method = "paper"}, {32, 64, 128}, {1e-3, 1e-4, 1e-5, 1e-6});
    add(design, {.method = "projected_gradient"}, {32, 64, 128}, {1e-2, 1e-4, 1e-6});
  }
  return design;
}

}  // namespace slipstick::bench
