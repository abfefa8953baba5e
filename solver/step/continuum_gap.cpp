#include "solver/step/continuum_gap.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "solver/contact/certificate.hpp"
#include "solver/grid/grid_transfer.hpp"
#include "solver/model/make_model.hpp"
#include "solver/step/cell_energy.hpp"
#include "solver/step/dual_norm.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr Index kParts = 3;  // of a cell along each side

/// Rules over the parts of a cell, for a cell's area 1: weights of a corner, a side and the middle. At the
/// sides of cells s grows like x ln x. The mean of the gap is too large by 5 % for the paper's sphere, a rule
/// that integrates polynomials of degree 3 by 15 %. The error of an energy by its mean is a ninth of the
/// error by the middle value: without the middle these errors cancel.
struct Rule {
  double corner, side, middle;
};
constexpr Rule kMean{1.0 / 9.0, 1.0 / 9.0, 1.0 / 9.0};
constexpr Rule kThirdDegree{9.0 / 64.0, 6.0 / 64.0, 4.0 / 64.0};
constexpr Rule kWithoutMiddle{1.0 / 8.0, 1.0 / 8.0, 0.0};

/// Over the cells of a field with one component.
double integral(const Grid& fine, const ArrayXd& field, const Rule& rule) {
  double sum = 0.0;
  for (Index i = 0; i < fine.n1; ++i) {
    const auto [outer, inner] =
        i % kParts == 1 ? std::array{rule.side, rule.middle} : std::array{rule.corner, rule.side};
    double row = 0.0;
    for (Index j = 0; j < fine.n2; ++j) row += (j % kParts == 1 ? inner : outer) * field[i * fine.n2 + j];
    sum += row;
  }
  return sum * static_cast<double>(kParts * kParts) * fine.cell_area();
}

/// By the mean, with its difference from another rule.
Estimate estimate(const Grid& fine, const ArrayXd& field, const Rule& other) {
  const double mean = integral(fine, field, kMean);
  return {mean, std::abs(mean - integral(fine, field, other))};
}

/// By the rule without the middle, with its difference from the mean.
Estimate energy_of(const Grid& fine, const ArrayXd& density) {
  const double energy = integral(fine, density, kWithoutMiddle);
  return {energy, std::abs(energy - integral(fine, density, kMean))};
}

/// 1 in stick cells and their neighbours, linear between the centres of cells; zero in the outermost cells.
ArrayXd near_stick(const Grid& fine, const Grid& grid, const ArrayXd& stick) {
  ArrayXd near = ArrayXd::Zero(grid.cells());
  const Index margin = grid.quadrant ? 0 : 1;
  for (Index i = margin; i + 1 < grid.n1; ++i) {
    for (Index j = margin; j + 1 < grid.n2; ++j) {
      for (Index k = std::max<Index>(i - 1, 0); k <= i + 1; ++k) {
        for (Index l = std::max<Index>(j - 1, 0); l <= j + 1; ++l)
          near[i * grid.n2 + j] = std::max(near[i * grid.n2 + j], stick[k * grid.n2 + l]);
      }
    }
  }
  return prolong_to(fine, grid, near, normal_symmetry());
}

/// The least bound for some parts r = a(x) s of the slip that are left to the dual norm: the integral of
/// q.(s - r) + f |s - r| = (1 - a)(q.s + f |s|), and |r|^2/2. density: q.s + f |s|; near: one where cells
/// stick. a is the part of s below a limit, there.
Estimate least_bound(const Grid& fine, const ArrayXd& slip, const ArrayXd& density, const ArrayXd& near,
                     double compliance) {
  Estimate least = estimate(fine, density, kThirdDegree);
  const ArrayXd size = norms(slip);
  const double largest = (near == 1.0).select(size, 0.0).maxCoeff();
  for (const double limit : {0.5 * largest, 0.2 * largest, 0.08 * largest}) {
    const ArrayXd left = near * (limit / size.max(limit));
    const Estimate open = estimate(fine, (1.0 - left) * density, kThirdDegree);
    const Estimate norm = dual_norm_squared(fine, left.replicate(2, 1) * slip, torsion_symmetry(), compliance);
    const Estimate found{open.value + 0.5 * norm.value, open.error + 0.5 * norm.error};
    if (found.value + found.error < least.value + least.error) least = found;
  }
  return least;
}

void require_one_step(const Scene& scene, const Solution& solution) {
  if (scene.steps.size() != 1 || scene.cycles != 1 || scene.solver.substeps != 1)
    throw std::invalid_argument("the contact has a history of loads");
  if (solution.coupled) throw std::invalid_argument("the pressure displaces the surfaces tangentially");
  if (solution.grid.ranks.several()) throw std::invalid_argument("several processes share the grid");
}

/// C such that waves of tractions displace the surfaces by C/|xi| times them or more; zero: not known.
double least_compliance(const Scene& scene, const ElasticPair& pair) {
  if (!is_bare(scene) || scene.ends_at_grid_edge) return 0.0;
  return std::min(pair.shear_compliance, pair.normal_compliance);
}

/// Bounds of the energy's error, and of the squared distance of the pressure from the true one.
struct PressureBounds {
  Estimate gap;
  double squared_distance;
};

/// w: the gap, up to the approach. With a known compliance the approach makes w zero in the mean over the
/// pressure, and the dual norm takes the overlap; otherwise the approach is the least w.
PressureBounds bounds_of_pressure(const Grid& fine, const ArrayXd& p, ArrayXd w, double compliance) {
  w -= compliance > 0.0 ? (p > 0.0).select(p * w, 0.0).sum() / p.sum() : w.minCoeff();
  const Estimate open = estimate(fine, (p > 0.0).select(p * w.max(0.0), 0.0), kThirdDegree);
  if (!(compliance > 0.0)) return {open, open.value + open.error};
  const Estimate overlap = dual_norm_squared(fine, (-w).max(0.0), normal_symmetry(), compliance);
  const Estimate gap{open.value + 0.5 * overlap.value, open.error + 0.5 * overlap.error};
  // d^2 <= open + |overlap| d
  const double norm = std::sqrt(overlap.value + overlap.error);
  const double distance = 0.5 * norm + std::sqrt(0.25 * norm * norm + open.value + open.error);
  return {gap, distance * distance};
}

}  // namespace

ContinuumGap continuum_gap(const Scene& scene, const Solution& solution, std::shared_ptr<SolveCache> cache) {
  require_one_step(scene, solution);
  Scene constant_cells = scene;
  constant_cells.solver.cell_traction = CellTraction::constant;
  constant_cells.solver.op = OperatorKind::dcfft;
  const Model model = make_model(constant_cells);
  const Dimensionless unit = model.on_grid(solution.grid, {0.0, 0.0});
  const ArrayXd bound = unit.friction.bound(ArrayXd(solution.pressure / unit.stress_unit));
  const bool moves = solution.displacement[0] != 0.0 || solution.displacement[1] != 0.0;
  const Reduction part = moves ? Reduction(unit.grid, bound) : Reduction(unit.grid, bound, bound);
  const Grid& grid = part.grid();
  const Grid fine = divided(grid, kParts);
  Elasticity elasticity = solver::elasticity(constant_cells, model, part);
  elasticity.law = unit.law;
  elasticity.cache = std::move(cache);

  const ArrayXd of_cells = part.restricted(solution.traction / unit.stress_unit);
  const ArrayXd q = spread_to(fine, grid, of_cells);
  const ArrayXd f = spread_to(fine, grid, part.restricted(bound));
  ArrayXd u = elasticity.make(fine, tangential_kernel())->applied(q);
  elasticity.diagonal = false;
  Estimate energy = missing_energy(elasticity, grid, of_cells, tangential_kernel(), torsion_symmetry());
  energy.value += integral(fine, 0.5 * dot_products(q, u), kWithoutMiddle);
  ArrayXd s = std::move(u) - solution.twist_angle * rotation_field(fine);
  s.head(fine.cells()) -= solution.displacement[0] / unit.length_unit;
  s.tail(fine.cells()) -= solution.displacement[1] / unit.length_unit;
  const ArrayXd density = dot_products(q, s) + f * norms(s);
  const double compliance = least_compliance(scene, unit.pair);
  const Estimate gap =
      compliance > 0.0
          ? least_bound(fine, s, density, near_stick(fine, grid, part.restricted(solution.stick)), compliance)
          : estimate(fine, density, kThirdDegree);
  const double images = part.quadrant() ? 4.0 : 1.0;
  const ArrayXd means = restrict_to(grid, fine, density) * (unit.stress_unit * unit.length_unit);
  return {.gap = gap.value / energy.value,
          .energy = images * energy.value * unit.moment_unit(),
          .quadrature_error = (gap.error + energy.error) / energy.value,
          .density = part.expanded(means, normal_symmetry())};
}

PressureGap pressure_gap(const Scene& scene, const Solution& solution) {
  if (scene.contact.pressure == PressureModel::file) throw std::invalid_argument("the pressure comes from a file");
  const Grid& grid = solution.grid;
  Scene fine = scene;
  fine.solver.cell_traction = CellTraction::constant;
  fine.solver.op = OperatorKind::dcfft;
  fine.grid.cells = {kParts * grid.n1, kParts * grid.n2};
  fine.grid.extent = {static_cast<double>(grid.n1) * grid.h1, static_cast<double>(grid.n2) * grid.h2};
  const Model model = make_model(fine);
  const Reduction& part = model.pressure_part;
  const ArrayXd p = part.restricted(spread_to(model.grid, grid, ArrayXd(solution.pressure / model.stress_unit)));
  const ArrayXd h = part.restricted(model.gap);
  Elasticity elasticity = solver::elasticity(fine, model, part);
  elasticity.cache = nullptr;
  ArrayXd w = elasticity.make(part.grid(), normal_kernel())->applied(p);
  const Estimate energy = energy_of(part.grid(), 0.5 * p * w);
  w += part.restricted(model.gap);
  const auto [gap, distance] = bounds_of_pressure(part.grid(), p, w, least_compliance(scene, model.pair));
  const double images = part.quadrant() ? 4.0 : 1.0;
  return {.gap = gap.value / energy.value,
          .energy = images * energy.value * model.moment_unit(),
          .quadrature_error = (gap.error + energy.error) / energy.value,
          .distance = std::sqrt(images * distance * model.moment_unit())};
}

double friction_bound_error(const Scene& scene, const Solution& solution, const PressureGap& pressure) {
  if (!scene.contact.friction.is_coulomb())
    throw std::invalid_argument("the friction bound is not the pressure times one number");
  if (!is_bare(scene) || scene.ends_at_grid_edge)
    throw std::invalid_argument("the bodies are not half-spaces that touch each other");
  double shear = 0.0;  // of the bodies: sums of 1/G and of (1 - nu)/G
  double normal = 0.0;
  for (const Material* const body : {&scene.lower, &scene.upper}) {
    const double compliance = 2.0 * (1.0 + body->poisson_ratio) / body->young_modulus;
    shear += compliance;
    normal += (1.0 - body->poisson_ratio) * compliance;
  }
  const Grid& grid = solution.grid;
  const ArrayXd farthest =
      (cell_x1(grid).abs() + 0.5 * grid.h1).square() + (cell_x2(grid).abs() + 0.5 * grid.h2).square();
  const double radius = std::sqrt((solution.pressure > 0.0).select(farthest, 0.0).maxCoeff());
  // Moment over twist and force over displacement of a disc that is bonded to the pair (Mindlin 1949).
  const double rotational = 16.0 / 3.0 * std::pow(radius, 3) / shear;
  const double translational = 8.0 * radius / (shear + normal);
  const double slip = std::sqrt(2.0 * solution.elastic_energy) +
                      std::sqrt(rotational) * std::abs(solution.twist_angle) +
                      std::sqrt(translational) * std::hypot(solution.displacement[0], solution.displacement[1]);
  return scene.contact.friction.coefficient * pressure.distance * std::sqrt(std::max(shear, normal) / normal) * slip;
}

}  // namespace slipstick::solver
