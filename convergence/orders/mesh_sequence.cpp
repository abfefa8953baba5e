#include "convergence/orders/mesh_sequence.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace slipstick::convergence {
namespace {

/// Why a sample is no number; empty if it is one.
std::string flaw(const MeshSample& sample) {
  const bool number = sample.grids > 0 && std::isfinite(sample.value) && std::isfinite(sample.spread);
  if (!number) return fmt::format("no number at size {:.4g}", sample.size);
  return std::isfinite(sample.noise) ? "" : fmt::format("no noise is known at size {:.4g}", sample.size);
}

}  // namespace

std::string to_string(OrderVerdict verdict) {
  constexpr std::array kWords{"asymptotic",  "preasymptotic", "superconvergent",
                              "oscillatory", "floor",         "too_few"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

MeshSequence coarsest_first(const std::vector<MeshSample>& samples) {
  MeshSequence sequence;
  for (const MeshSample& sample : samples) {
    if (!(sample.size > 0.0)) throw std::invalid_argument(fmt::format("a mesh of size {}", sample.size));
    const std::string reason = flaw(sample);
    if (reason.empty()) {
      sequence.meshes.push_back(sample);
    } else {
      sequence.left_out += (sequence.left_out.empty() ? "" : ", ") + reason;
    }
  }
  std::ranges::sort(sequence.meshes, std::ranges::greater{}, &MeshSample::size);
  const auto twice = std::ranges::adjacent_find(sequence.meshes, {}, &MeshSample::size);
  if (twice != sequence.meshes.end()) {
    throw std::invalid_argument(fmt::format("two meshes of size {}", twice->size));
  }
  return sequence;
}

double standard_error(const MeshSample& sample) { return sample.spread / std::sqrt(sample.grids); }

double uncertainty(const MeshSample& sample) {
  return sample.noise + kBelievedScatter * standard_error(sample);
}

double resolution(const MeshSample& sample) {
  return std::max(kAboveNoise * sample.noise, kBelievedScatter * standard_error(sample));
}

bool is_non_monotone(const std::vector<MeshSample>& meshes) {
  bool rises = false;
  bool falls = false;
  for (std::size_t i = 0; i + 1 < meshes.size(); ++i) {
    const double step = meshes[i + 1].value - meshes[i].value;
    const double noise = resolution(meshes[i]) + resolution(meshes[i + 1]);
    rises |= step > noise;
    falls |= step < -noise;
  }
  return rises && falls;
}

}  // namespace slipstick::convergence
