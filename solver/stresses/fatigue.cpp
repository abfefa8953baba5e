#include "solver/stresses/fatigue.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "solver/stresses/smallest_ball.hpp"

namespace slipstick::solver {
namespace {

constexpr double kPlaneError = 1e-5;

using Flat = Eigen::Matrix<double, 9, 1>;

Tensor deviator(const Tensor& stress) { return stress - stress.trace() / 3.0 * Tensor::Identity(); }

/// Upper bounds of a cycle, from norms only: the shear stress of a deviator is at most its norm over
/// sqrt(2), its largest principal value sqrt(2/3) of its norm.
struct Bounds {
  double amplitude = 0.0;  ///< of the shear stress on any plane
  double shear = 0.0;
  double hydrostatic = -std::numeric_limits<double>::infinity();
  double normal = -std::numeric_limits<double>::infinity();  ///< stress on any plane
};

Bounds bounds(std::span<const Tensor> states) {
  Tensor mean = Tensor::Zero();
  for (const Tensor& stress : states) mean += deviator(stress) / static_cast<double>(states.size());
  Bounds most;
  for (const Tensor& stress : states) {
    const Tensor part = deviator(stress);
    const double hydrostatic = stress.trace() / 3.0;
    most.amplitude = std::max((part - mean).norm() * M_SQRT1_2, most.amplitude);
    most.shear = std::max(part.norm() * M_SQRT1_2, most.shear);
    most.hydrostatic = std::max(hydrostatic, most.hydrostatic);
    most.normal = std::max(hydrostatic + part.norm() * std::sqrt(2.0 / 3.0), most.normal);
  }
  return most;
}

/// Empty where the plane has no more than `above`.
std::optional<Findley> on_plane(std::span<const Tensor> states, double k, const Eigen::Vector3d& normal,
                                double above, std::vector<Eigen::Vector3d>& shears) {
  double largest = -std::numeric_limits<double>::infinity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  shears.clear();
  for (const Tensor& stress : states) {
    const Eigen::Vector3d traction = stress * normal;
    const double across = traction.dot(normal);
    largest = std::max(across, largest);
    shears.push_back(traction - across * normal);
    sum += shears.back();
  }
  double most = 0.0;  // about the mean: at least the smallest
  for (const Eigen::Vector3d& shear : shears)
    most = std::max((shear - sum / static_cast<double>(shears.size())).norm(), most);
  if (most + k * largest <= above) return {};
  const double amplitude = SmallestBall<3>(shears).radius();
  return Findley{amplitude + k * largest, amplitude, largest, {normal[0], normal[1], normal[2]}};
}

/// Planes whose normals pass through a square of a cube's face.
struct Patch {
  int axis;  ///< of the face
  double u, v;
  Eigen::Vector3d middle() const {
    Eigen::Vector3d normal;
    normal[axis] = 1.0;
    normal[(axis + 1) % 3] = u;
    normal[(axis + 2) % 3] = v;
    return normal.normalized();
  }
};

}  // namespace

DangVan dang_van(std::span<const Tensor> states, double alpha) {
  std::vector<Flat> deviators;
  for (const Tensor& stress : states) deviators.emplace_back(deviator(stress).reshaped());
  const Flat center = SmallestBall<9>(deviators).center();
  DangVan found{-std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0};
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Tensor amplitude = (deviators[i] - center).reshaped(3, 3);
    const Eigen::Vector3d principal = amplitude.selfadjointView<Eigen::Lower>().eigenvalues();
    const double shear = 0.5 * (principal[2] - principal[0]);
    const double hydrostatic = states[i].trace() / 3.0;
    smallest = std::min(hydrostatic, smallest);
    largest = std::max(hydrostatic, largest);
    if (shear + alpha * hydrostatic > found.value) found = {shear + alpha * hydrostatic, shear, 0.0, 0.0};
  }
  found.hydrostatic_mean = 0.5 * (smallest + largest);
  found.hydrostatic_largest = largest;
  return found;
}

/// With T, S the bounds of amplitude and shear stress, a plane within the angle d of the best one has at
/// least its value less 2 d^2 (T + k S). Proof: at the best plane the radius of the smallest circle is the
/// deviation of the shear stresses for some weights of the states, and that deviation is a lower bound at
/// every other plane. Along a great circle it is the norm of a vector whose second derivative is at most 4 T,
/// and the normal stress's is at most 4 S; the first derivative of the sum vanishes at the best plane.
std::optional<Findley> findley(std::span<const Tensor> states, double k, double above) {
  const Bounds bound = bounds(states);
  const double scale = bound.amplitude + k * bound.shear;
  std::optional<Findley> best;
  std::vector<Eigen::Vector3d> shears;
  std::vector<Patch> patches{{0, 0.0, 0.0}, {1, 0.0, 0.0}, {2, 0.0, 0.0}};
  for (double half = 1.0; !patches.empty(); half *= 0.5) {
    const double error = 4.0 * half * half * scale;  // the angle is at most sqrt(2) half
    std::vector<std::pair<Patch, double>> left;
    for (const Patch& patch : patches) {
      const auto found = on_plane(states, k, patch.middle(), above - error, shears);
      if (!found) continue;
      left.emplace_back(patch, found->value + error);
      if (!(found->value > above)) continue;
      best = found;
      above = found->value;
    }
    if (error <= kPlaneError * scale) break;
    patches.clear();
    for (const auto& [patch, most] : left) {
      if (!(most > above)) continue;
      for (const double u : {-0.5 * half, 0.5 * half})
        for (const double v : {-0.5 * half, 0.5 * half})
          patches.push_back({patch.axis, patch.u + u, patch.v + v});
    }
  }
  return best;
}

void LargestFatigue::include(std::span<const StressPlane> states, const FatigueCoefficients& asked,
                             const Grid& grid) {
  std::vector<Tensor> cycle(states.size());
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    const std::array<double, 3> at{grid.x1(cell / grid.n2), grid.x2(cell % grid.n2), states[0].depth};
    const auto keep = [&](auto& largest, const auto& found) {
      if (!(found.value <= largest.found.value) && !std::isnan(largest.found.value)) largest = {found, at};
    };
    for (std::size_t i = 0; i < states.size(); ++i) {
      const auto s = [&](Stress a) { return states[i].stress[a][cell]; };
      cycle[i] << s(k11), s(k12), s(k13), s(k12), s(k22), s(k23), s(k13), s(k23), s(k33);
    }
    const Bounds most = bounds(cycle);
    if (std::isnan(most.amplitude)) {  // as of any state
      keep(shear, DangVan{most.amplitude, {}, {}, {}});
      keep(dang_van, DangVan{most.amplitude, {}, {}, {}});
      keep(findley, Findley{most.amplitude, {}, {}, {}});
      continue;
    }
    if (!(most.amplitude <= shear.found.value)) keep(shear, solver::dang_van(cycle, 0.0));
    if (const auto alpha = asked.dang_van;
        alpha && !(most.amplitude + *alpha * most.hydrostatic <= dang_van.found.value))
      keep(dang_van, solver::dang_van(cycle, *alpha));
    if (const auto k = asked.findley; k && !(most.amplitude + *k * most.normal <= findley.found.value))
      if (const auto found = solver::findley(cycle, *k, findley.found.value)) keep(findley, *found);
  }
}

}  // namespace slipstick::solver
