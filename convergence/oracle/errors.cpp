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

/// A grid about the axis has mirror images of each cell of its first quadrant, in which exact fields are
/// equal but for signs: those are found once. A grid about another place has none.
class Images {
 public:
  Images(const Oracle& oracle, const solver::Grid& grid)
      : n1_(grid.n1),
        n2_(grid.n2),
        mirrored_(oracle.centre == std::array<double, 2>{} && oracle.axis_ratio == 1.0 && !grid.quadrant),
        turns_(oracle.direction == std::array<double, 2>{}) {}

  Index rows() const { return mirrored_ ? (n1_ + 1) / 2 : n1_; }
  Index columns() const { return mirrored_ ? (n2_ + 1) / 2 : n2_; }

  /// visit(image, sign1, sign2) for a cell of the first rows() and columns() and each of its images.
  template <typename Visit>
  void each(Index i, Index j, const Visit& visit) const {
    visit(i * n2_ + j, 1.0, 1.0);
    if (!mirrored_) return;
    const double sign = turns_ ? -1.0 : 1.0;
    const Index k = n1_ - 1 - i;
    const Index l = n2_ - 1 - j;
    visit(k * n2_ + j, 1.0, sign);
    visit(i * n2_ + l, sign, 1.0);
    visit(k * n2_ + l, sign, sign);
  }

 private:
  Index n1_;
  Index n2_;
  bool mirrored_;
  bool turns_;  ///< tractions go round the axis, as (-x2, x1) does
};

/// Averages are taken over so many points of a cell along each side. An edge of the traction is a square
/// root, of whose difference between centre and average this leaves about (1/12)^(3/2), 2 %.
constexpr int kPointsAcross = 12;
/// Steps of the tables of the exact traction near its edges, a cell: finer than the points.
constexpr double kTableSteps = 64.0;

/// The mean over a cell of the exact traction, whose size at a radius is given. y1, y2: of its centre.
template <typename Size>
std::array<double, 2> mean_over_cell(const Oracle& oracle, const solver::Grid& grid, double y1, double y2,
                                     const Size& size_at) {
  constexpr int points = kPointsAcross;
  std::array<double, 2> sum{};
  for (int k = 0; k < points * points; ++k) {
    const double part1 = (k / points + 0.5) / points - 0.5;
    const double part2 = (k % points + 0.5) / points - 0.5;
    const auto [q1, q2] = shear_at(oracle, y1 + part1 * grid.h1, y2 + part2 * grid.h2, size_at);
    sum[0] += q1;
    sum[1] += q2;
  }
  return {sum[0] / (points * points), sum[1] / (points * points)};
}

/// Averages over the cells near an edge, values at the centres elsewhere, where the two differ by h^2/24
/// times the traction's second derivatives. 2*cells, Pa.
ArrayXd averaged_traction(const Oracle& oracle, const solver::Grid& grid, const ExactFields& at_centres) {
  const double diagonal = std::hypot(grid.h1, grid.h2);
  const ShearBesideEdges beside_edges(oracle, 2.0 * diagonal, std::min(grid.h1, grid.h2) / kTableSteps);
  ArrayXd field = at_centres.traction;
  const Images images(oracle, grid);
  for (Index i = 0; i < images.rows(); ++i) {
    for (Index j = 0; j < images.columns(); ++j) {
      const double radius = at_centres.radius[i * grid.n2 + j];
      const auto is_near = [&](double edge) { return std::abs(radius - edge) < diagonal; };
      if (!is_near(oracle.stick_radius) && !is_near(oracle.contact_radius)) continue;
      const auto [q1, q2] = mean_over_cell(oracle, grid, grid.x1(i) - oracle.centre[0],
                                           grid.x2(j) - oracle.centre[1], beside_edges);
      images.each(i, j, [&, q1 = q1, q2 = q2](Index image, double sign1, double sign2) {
        field[image] = sign1 * q1;
        field[image + grid.cells()] = sign2 * q2;
      });
    }
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
  ByRadius pressure_at([&](double radius) { return oracle.pressure(radius); });
  ByRadius shear([&](double radius) { return oracle.traction(radius); });
  const Index cells = grid.cells();
  ExactFields exact{ArrayXd(cells), ArrayXd(cells), ArrayXd(2 * cells)};
  const Images images(oracle, grid);
  for (Index i = 0; i < images.rows(); ++i) {
    for (Index j = 0; j < images.columns(); ++j) {
      const double y1 = grid.x1(i) - oracle.centre[0];
      const double y2 = grid.x2(j) - oracle.centre[1];
      const double radius = oracle.radius(y1, y2);
      const double pressure = pressure_at(radius);
      const auto [q1, q2] = shear_at(oracle, y1, y2, shear);
      images.each(i, j, [&, q1 = q1, q2 = q2](Index image, double sign1, double sign2) {
        exact.radius[image] = radius;
        exact.pressure[image] = pressure;
        exact.traction[image] = sign1 * q1;
        exact.traction[image + cells] = sign2 * q2;
      });
    }
  }
  return exact;
}

namespace {

TractionError traction_error(const ArrayXd& traction, const Oracle& oracle, const solver::Grid& grid,
                             const ExactFields& fields) {
  if (!oracle.shear) return unknown_tractions();
  const ArrayXd& at_centres = fields.traction;
  const ArrayXd averaged = averaged_traction(oracle, grid, fields);
  const ArrayXd exact = solver::norms(averaged);
  const ArrayXd difference = solver::norms(traction - averaged);
  const double width = kEdgeBand * std::sqrt(grid.cell_area());
  const bool slips = oracle.stick_radius < oracle.contact_radius;
  const ArrayXd stick_edge =
      slips ? band(fields.radius, oracle.stick_radius, width) : ArrayXd::Zero(fields.radius.size());
  const ArrayXd contact_edge = (1.0 - stick_edge) * band(fields.radius, oracle.contact_radius, width);
  const ArrayXd rest = 1.0 - stick_edge - contact_edge;
  const ArrayXd sticks = (fields.radius < oracle.stick_radius).cast<double>();
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
