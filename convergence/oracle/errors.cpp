#include "convergence/oracle/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

double relative_error(double value, double exact) {
  return std::isfinite(exact) ? value / exact - 1.0 : std::numeric_limits<double>::quiet_NaN();
}

/// Length of the difference over that of the exact vector.
double relative_difference(const std::array<double, 2>& value, const std::array<double, 2>& exact) {
  return std::hypot(value[0] - exact[0], value[1] - exact[1]) / std::hypot(exact[0], exact[1]);
}

/// Both given as sizes in each cell: of the difference, and of the exact field.
FieldError field_error(const ArrayXd& difference, const ArrayXd& exact) {
  return {difference.sum() / exact.sum(), std::sqrt(difference.square().sum() / exact.square().sum()),
          difference.maxCoeff<Eigen::PropagateNaN>() / exact.maxCoeff<Eigen::PropagateNaN>()};
}

/// Of the cells that `part` holds, 1 or 0 each, over the whole exact field.
FieldError field_error(const ArrayXd& difference, const ArrayXd& exact, const ArrayXd& part) {
  return field_error(difference * part, exact);
}

/// A function of the radius, found once at each: mirror images of a cell have its own, to the last bit.
template <typename Function>
class ByRadius {
 public:
  explicit ByRadius(Function function) : function_(std::move(function)) {}
  double operator()(double radius) {
    const auto [place, is_new] = found_.try_emplace(radius);
    if (is_new) place->second = function_(radius);
    return place->second;
  }

 private:
  Function function_;
  std::unordered_map<double, double> found_;
};

/// The exact shear traction in an oracle's units, as a vector at a place measured from the axis; size: its
/// size at a radius.
template <typename Size>
std::array<double, 2> shear_at(const Oracle& oracle, double y1, double y2, Size&& size_at) {
  const double radius = std::hypot(y1, y2);
  const double size = size_at(radius);
  if (oracle.direction != std::array<double, 2>{}) {
    return {size * oracle.direction[0], size * oracle.direction[1]};
  }
  if (radius == 0.0) return {0.0, 0.0};  // the axis carries no traction
  return {-size * (y2 / radius), size * (y1 / radius)};
}

/// The size of the exact shear traction near its edges, where many values are asked for.
class ShearBesideEdges {
 public:
  ShearBesideEdges(const Oracle& oracle, double reach, double step) : oracle_(oracle) {
    for (const double edge : {oracle.stick_radius, oracle.contact_radius}) {
      if (!std::isfinite(edge)) continue;
      // No value is taken on the edge itself, where it may be infinite.
      const double start = edge - (std::floor(std::min(reach, edge) / step) - 0.5) * step;
      Table table{start, step, {}};
      for (int i = 0; start + i * step <= edge + reach; ++i) {
        table.values.push_back(oracle.traction(start + i * step));
      }
      tables_.push_back(std::move(table));
    }
  }

  double operator()(double radius) const {
    for (const Table& table : tables_) {
      const double place = (radius - table.start) / table.step;
      if (!(place >= 0.0) || !(place + 1.0 < static_cast<double>(table.values.size()))) continue;
      const auto i = static_cast<std::size_t>(place);
      const double part = place - static_cast<double>(i);
      return (1.0 - part) * table.values[i] + part * table.values[i + 1];
    }
    return oracle_.traction(radius);
  }

 private:
  /// Values at equal steps, straight lines between them.
  struct Table {
    double start;
    double step;
    std::vector<double> values;
  };

  const Oracle& oracle_;
  std::vector<Table> tables_;
};

/// Places of the cell centres in metres, measured from the axis.
struct Places {
  ArrayXd y1;
  ArrayXd y2;
  ArrayXd radius;  ///< as the oracle measures it
};

Places places(const Oracle& oracle, const solver::Grid& grid) {
  const ArrayXd y1 = solver::cell_x1(grid) - oracle.centre[0];
  const ArrayXd y2 = solver::cell_x2(grid) - oracle.centre[1];
  return {y1, y2, y1.binaryExpr(y2, [&](double a, double b) { return oracle.radius(a, b); })};
}

/// Averages are taken over so many points of a cell along each side. An edge of the traction is a square
/// root, of whose difference between centre and average this leaves about (1/12)^(3/2), 2 %.
constexpr int kPointsAcross = 12;
/// Steps of the tables of the exact traction near its edges, a cell: finer than the points.
constexpr double kTableSteps = 64.0;

/// Averages over the cells near an edge, values at the centres elsewhere, where the two differ by h^2/24
/// times the traction's second derivatives. 2*cells, Pa.
ArrayXd averaged_traction(const Oracle& oracle, const solver::Grid& grid, const Places& at,
                          const ArrayXd& at_centres) {
  const Index cells = at.radius.size();
  const double h1 = grid.h1;
  const double h2 = grid.h2;
  const double diagonal = std::hypot(h1, h2);
  const ShearBesideEdges beside_edges(oracle, 2.0 * diagonal, std::min(h1, h2) / kTableSteps);
  const auto is_near = [&](double radius, double edge) { return std::abs(radius - edge) < diagonal; };
  constexpr int points = kPointsAcross;
  ArrayXd field = at_centres;
  for (Index i = 0; i < cells; ++i) {
    if (!is_near(at.radius[i], oracle.stick_radius) && !is_near(at.radius[i], oracle.contact_radius))
      continue;
    std::array<double, 2> sum{};
    for (int k = 0; k < points * points; ++k) {
      const double part1 = (k / points + 0.5) / points - 0.5;
      const double part2 = (k % points + 0.5) / points - 0.5;
      const auto [q1, q2] = shear_at(oracle, at.y1[i] + part1 * h1, at.y2[i] + part2 * h2, beside_edges);
      sum[0] += q1;
      sum[1] += q2;
    }
    field[i] = sum[0] / (points * points);
    field[i + cells] = sum[1] / (points * points);
  }
  return field;
}

TractionError unknown_tractions() {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  constexpr FieldError field{unknown, unknown, unknown};
  return {field, field, field, field, field, field};
}

ArrayXd band(const ArrayXd& radius, double edge, double width) {
  return ((radius - edge).abs() <= width).cast<double>();
}

}  // namespace

ExactFields exact_fields(const Oracle& oracle, const solver::Grid& grid) {
  const Places at = places(oracle, grid);
  ByRadius pressure([&](double radius) { return oracle.pressure(radius); });
  ByRadius shear([&](double radius) { return oracle.traction(radius); });
  const Index cells = at.radius.size();
  ExactFields exact{at.radius, ArrayXd(cells), ArrayXd(2 * cells)};
  for (Index i = 0; i < cells; ++i) {
    exact.pressure[i] = pressure(at.radius[i]);
    const auto [q1, q2] = shear_at(oracle, at.y1[i], at.y2[i], shear);
    exact.traction[i] = q1;
    exact.traction[i + cells] = q2;
  }
  return exact;
}

namespace {

TractionError traction_error(const ArrayXd& traction, const Oracle& oracle, const solver::Grid& grid,
                             const ExactFields& fields) {
  if (!oracle.shear) return unknown_tractions();
  const ArrayXd& at_centres = fields.traction;
  const Places at = places(oracle, grid);
  const ArrayXd averaged = averaged_traction(oracle, grid, at, at_centres);
  const ArrayXd exact = solver::norms(averaged);
  const ArrayXd difference = solver::norms(traction - averaged);
  const double width = kEdgeBand * std::sqrt(grid.cell_area());
  const bool slips = oracle.stick_radius < oracle.contact_radius;
  const ArrayXd stick_edge =
      slips ? band(at.radius, oracle.stick_radius, width) : ArrayXd::Zero(at.radius.size());
  const ArrayXd contact_edge = (1.0 - stick_edge) * band(at.radius, oracle.contact_radius, width);
  const ArrayXd rest = 1.0 - stick_edge - contact_edge;
  const ArrayXd sticks = (at.radius < oracle.stick_radius).cast<double>();
  return {
      .at_centres = field_error(solver::norms(traction - at_centres), solver::norms(at_centres)),
      .averaged = field_error(difference, exact),
      .stick_edge = field_error(difference, exact, stick_edge),
      .contact_edge = field_error(difference, exact, contact_edge),
      .inside = field_error(difference, exact, rest * sticks),
      .outside = field_error(difference, exact, rest * (1.0 - sticks)),
  };
}

FieldError pressure_error(const ArrayXd& pressure, const ArrayXd& exact) {
  const auto finite = exact.isFinite();
  const ArrayXd difference = (pressure - exact).abs();
  return field_error(finite.select(difference, 0.0), finite.select(exact, 0.0));
}

}  // namespace

TractionError traction_error(const ArrayXd& traction, const Oracle& oracle, const solver::Grid& grid) {
  return traction_error(traction, oracle, grid, exact_fields(oracle, grid));
}

FieldError pressure_error(const ArrayXd& pressure, const Oracle& oracle, const solver::Grid& grid) {
  return pressure_error(pressure, exact_fields(oracle, grid).pressure);
}

Errors compare(const solver::Solution& solution, const Oracle& oracle) {
  const ExactFields exact = exact_fields(oracle, solution.grid);
  return {
      .twist = relative_error(solution.twist_angle, oracle.twist_angle),
      .moment = relative_error(solution.moment, oracle.moment),
      .moment_limit = relative_error(solution.moment_limit, oracle.moment_limit),
      .stick_radius = relative_error(solution.stick_radius, oracle.stick_radius),
      .stick_ratio =
          relative_error(solution.stick_radius / solution.contact_radius, oracle.state.stick_ratio),
      .displacement = relative_difference(solution.displacement, oracle.displacement),
      .dissipated = relative_error(solution.dissipated, oracle.dissipated),
      .stick_radius_counted = relative_error(solution.stick_radius_counted, oracle.stick_radius),
      .contact_radius = relative_error(solution.contact_radius, oracle.contact_radius),
      .peak_pressure = relative_error(solution.peak_pressure, oracle.peak_pressure),
      .traction = traction_error(solution.traction, oracle, solution.grid, exact),
      .pressure = pressure_error(solution.pressure, exact.pressure),
  };
}

}  // namespace slipstick::convergence
