#include "solver/stresses/fatigue.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace slipstick::solver {
namespace {

constexpr double kPlaneError = 1e-5;

template <int D>
using Points = std::vector<Eigen::Matrix<double, D, 1>>;

/// Centre and radius of the smallest ball that holds all points: the convex combination of them with the
/// largest deviation, by an active set. The points lie within the radius up to a relative rounding of 1e-12.
template <int D>
std::pair<Eigen::Matrix<double, D, 1>, double> smallest_ball(const Points<D>& points) {
  Points<D> active{points.front()};
  std::vector<double> weights{1.0};
  auto center = points.front();
  for (std::size_t round = 1;; ++round) {
    const auto distance = [&](const auto& point) { return (point - center).squaredNorm(); };
    const auto farthest = std::ranges::max(points, {}, distance);
    const double square = distance(active.front());
    const bool stops = active.size() > D + 1 || round > 10 * points.size();  // by rounding
    if (stops || !(distance(farthest) > (1.0 + 1e-12) * square)) return {center, std::sqrt(distance(farthest))};
    active.push_back(farthest);
    weights.push_back(0.0);
    for (bool drops = true; drops;) {  // to the sphere through all active points, or to a weight of zero
      const auto sides = static_cast<Eigen::Index>(active.size()) - 1;
      Eigen::Matrix<double, D, Eigen::Dynamic, 0, D, D + 1> side(D, sides);
      for (Eigen::Index i = 0; i < sides; ++i) side.col(i) = active[count(i) + 1] - active[0];
      auto squares = (side.transpose() * side).eval();
      const auto half = (0.5 * squares.diagonal()).eval();
      squares.diagonal().array() += 1e-14 * squares.trace();  // points of a plane: finite weights
      const auto others = squares.ldlt().solve(half).eval();
      std::vector<double> to(others.begin(), others.end());
      to.insert(to.begin(), 1.0 - others.sum());
      double part = 1.0;
      std::size_t last = to.size();
      for (std::size_t i = 0; i < to.size(); ++i) {
        if (to[i] >= 0.0 || weights[i] > part * (weights[i] - to[i])) continue;
        part = weights[i] / (weights[i] - to[i]);
        last = i;
      }
      for (std::size_t i = 0; i < to.size(); ++i) weights[i] += part * (to[i] - weights[i]);
      drops = last < to.size();
      if (!drops) continue;
      active.erase(active.begin() + static_cast<std::ptrdiff_t>(last));
      weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(last));
    }
    center.setZero();
    for (std::size_t i = 0; i < active.size(); ++i) center += weights[i] * active[i];
  }
}

Tensor deviator(const Tensor& stress) { return stress - stress.trace() / 3.0 * Tensor::Identity(); }

Eigen::Vector3d principal(const Tensor& stress) { return stress.selfadjointView<Eigen::Lower>().eigenvalues(); }

/// An upper bound of the shear stress's amplitude on any plane: a deviator has at most its norm over sqrt(2).
/// NaN where a stress is.
double amplitude_bound(std::span<const Tensor> states) {
  Tensor mean = Tensor::Zero();
  for (const Tensor& stress : states) mean += deviator(stress) / static_cast<double>(states.size());
  double most = 0.0;
  for (const Tensor& stress : states) most = std::max((deviator(stress) - mean).norm() * M_SQRT1_2, most);
  return most;
}

/// The shear stresses are scratch. A value that is not above `above` may be left out.
Findley on_plane(std::span<const Tensor> states, double k, const Eigen::Vector3d& normal, double above,
                 Points<3>& shears) {
  shears.clear();
  Findley found{.normal = {normal[0], normal[1], normal[2]}};
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Tensor& stress : states) {
    const Eigen::Vector3d traction = stress * normal;
    const double across = traction.dot(normal);
    if (shears.empty() || across > found.normal_stress) found.normal_stress = across;
    shears.push_back(traction - across * normal);
    mean += shears.back() / static_cast<double>(states.size());
  }
  double most = 0.0;  // about the mean: the smallest circle is not larger
  for (const auto& shear : shears) most = std::max((shear - mean).norm(), most);
  if (most + k * found.normal_stress <= above) return found;
  found.shear = states.size() > 2 ? smallest_ball<3>(shears).second : most;
  found.value = found.shear + k * found.normal_stress;
  return found;
}

/// The middle of planes whose normals pass through a square of a cube's face.
Eigen::Vector3d normal_of(int face, double u, double v) {
  Eigen::Vector3d normal;
  normal[face] = 1.0;
  normal[(face + 1) % 3] = u;
  normal[(face + 2) % 3] = v;
  return normal.normalized();
}

}  // namespace

DangVan dang_van(std::span<const Tensor> states, double alpha) {
  Points<9> deviators;
  for (const Tensor& stress : states) deviators.emplace_back(deviator(stress).reshaped());
  const auto center = smallest_ball<9>(deviators).first;
  DangVan found;
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Tensor amplitude = (deviators[i] - center).reshaped(3, 3);
    const Eigen::Vector3d values = principal(amplitude);
    const double shear = 0.5 * (values[2] - values[0]);
    const double hydrostatic = states[i].trace() / 3.0;
    smallest = std::min(hydrostatic, smallest);
    largest = std::max(hydrostatic, largest);
    if (shear + alpha * hydrostatic > found.value) found = {shear + alpha * hydrostatic, shear};
  }
  found.hydrostatic_mean = 0.5 * (smallest + largest);
  found.hydrostatic_largest = largest;
  return found;
}

/// Squares are bisected. With T a bound of the shear stress's amplitude and S the largest shear stress, a plane within
/// the angle d of the best one has at least its value less 2 d^2 (T + k S). Proof: at the best plane the radius of the
/// smallest circle is the deviation of the shear stresses for some weights of the states, and that deviation is a lower
/// bound at every other plane. Along a great circle it is the norm of a vector whose second derivative is at most 4 T,
/// and the normal stress's is at most 4 S; the first derivative of the sum vanishes at the best plane.
void find_plane(std::span<const Tensor> states, double k, Findley& best) {
  const double amplitude = amplitude_bound(states);
  double shear = 0.0, normal = -std::numeric_limits<double>::infinity();
  for (const Tensor& stress : states) {
    const Eigen::Vector3d values = principal(stress);
    shear = std::max(0.5 * (values[2] - values[0]), shear);
    normal = std::max(values[2], normal);
  }
  if (!(amplitude + k * normal > best.value)) return;
  const double scale = amplitude + k * shear;
  struct Square {
    int face;
    double u, v, most;
  };
  constexpr double kNoBound = std::numeric_limits<double>::infinity();
  Points<3> shears;
  std::vector<Square> squares{{0, 0.0, 0.0, kNoBound}, {1, 0.0, 0.0, kNoBound}, {2, 0.0, 0.0, kNoBound}};
  for (double half = 1.0; !squares.empty(); half *= 0.5) {
    const double largest = 4.0 * half * half * scale;  // the angle is at most sqrt(2) half
    for (Square& square : squares) {
      const double u = std::max(std::abs(square.u) - half, 0.0), v = std::max(std::abs(square.v) - half, 0.0);
      const double error = largest / (1.0 + u * u + v * v);  // the cube lies farther out here
      const Findley found = on_plane(states, k, normal_of(square.face, square.u, square.v), best.value - error, shears);
      square.most = found.value + error;
      if (found.value > best.value) best = found;
    }
    if (largest <= kPlaneError * scale) return;
    std::vector<Square> finer;
    for (const Square& square : squares)
      for (const double u : {-0.5 * half, 0.5 * half})
        for (const double v : {-0.5 * half, 0.5 * half})
          if (square.most > best.value) finer.push_back({square.face, square.u + u, square.v + v, kNoBound});
    squares = std::move(finer);
  }
}

void LargestFatigue::include(std::span<const StressPlane> states, const FatigueCoefficients& asked, const Grid& grid) {
  std::vector<Tensor> cycle(states.size());
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    const std::array<double, 3> at{grid.x1(cell / grid.n2), grid.x2(cell % grid.n2), states[0].depth};
    double hydrostatic = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < states.size(); ++i) {
      const auto s = [&](Stress a) { return states[i].stress[a][cell]; };
      cycle[i] << s(k11), s(k12), s(k13), s(k12), s(k22), s(k23), s(k13), s(k23), s(k33);
      hydrostatic = std::max(cycle[i].trace() / 3.0, hydrostatic);
    }
    const double amplitude = amplitude_bound(cycle);
    if (std::isnan(amplitude)) dang_van.value = findley.value = amplitude;  // and stay so
    if (asked.dang_van && amplitude + *asked.dang_van * hydrostatic > dang_van.value) {
      const DangVan found = solver::dang_van(cycle, *asked.dang_van);
      if (found.value > dang_van.value) std::tie(dang_van, dang_van_at) = std::tie(found, at);
    }
    const double before = findley.value;
    if (asked.findley) find_plane(cycle, *asked.findley, findley);
    if (findley.value > before) findley_at = at;
  }
}

}  // namespace slipstick::solver
