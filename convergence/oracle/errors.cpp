#include "convergence/oracle/errors.hpp"

#include <utility>

#include "solver/grid/sweep.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

/// |difference| / |exact vector|.
double relative_difference(const std::array<double, 2>& value, const std::array<double, 2>& exact) {
  return std::hypot(value[0] - exact[0], value[1] - exact[1]) / std::hypot(exact[0], exact[1]);
}

/// Sum, sum of squares and maximum of the sizes of a field; NaN stays.
struct Norms {
  double sum = 0.0;
  double squares = 0.0;
  double max = 0.0;

  void add(double size) { *this += {size, size * size, size}; }
  Norms& operator+=(const Norms& other) {
    sum += other.sum;
    squares += other.squares;
    if (!(other.max <= max) && !std::isnan(max)) max = other.max;
    return *this;
  }
};

struct TractionNorms {
  Norms exact_at_centres, exact_averaged, at_centres, averaged, stick_edge, contact_edge, inside, outside;

  TractionNorms& operator+=(const TractionNorms& other) {
    for (const auto member : {&TractionNorms::exact_at_centres, &TractionNorms::exact_averaged,
                              &TractionNorms::at_centres, &TractionNorms::averaged, &TractionNorms::stick_edge,
                              &TractionNorms::contact_edge, &TractionNorms::inside, &TractionNorms::outside}) {
      this->*member += other.*member;
    }
    return *this;
  }
};

FieldError field_error(const Norms& difference, const Norms& exact) {
  return {difference.sum / exact.sum, std::sqrt(difference.squares / exact.squares), difference.max / exact.max};
}

/// The exact shear traction in an oracle's units, as a vector at a place measured from the axis; size: its
/// size at a radius.
template <typename Size>
std::array<double, 2> shear_at(const Oracle& oracle, double y1, double y2, Size&& size_at) {
  const double radius = std::hypot(y1, y2);
  const double size = size_at(radius);
  if (oracle.place.direction != std::array<double, 2>{}) {
    return {size * oracle.place.direction[0], size * oracle.place.direction[1]};
  }
  if (radius == 0.0) return {0.0, 0.0};  // the axis carries no traction
  return {-size * (y2 / radius), size * (y1 / radius)};
}

/// The size of the exact shear traction near its edges, where many values are needed.
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
/// equal but for signs: those are found once. About the diagonal of a square too, where the contact is round.
/// A grid about another place has none.
class Images {
 public:
  Images(const Oracle& oracle, const solver::Grid& grid)
      : n1_(grid.n1),
        n2_(grid.n2),
        mirrored_(oracle.place.centre == std::array<double, 2>{} &&
                  (oracle.place.axis_ratio == 1.0 || oracle.place.angle == 0.0) && !grid.quadrant),
        diagonal_(mirrored_ && oracle.place.axis_ratio == 1.0 && grid.n1 == grid.n2 && grid.h1 == grid.h2),
        turns_(oracle.place.direction == std::array<double, 2>{}) {}

  Index rows() const { return mirrored_ ? (n1_ + 1) / 2 : n1_; }
  Index columns() const { return mirrored_ ? (n2_ + 1) / 2 : n2_; }
  /// Whether cells (i, j) and (j, i) of these are images as well, by their distance from the axis.
  bool diagonal() const { return diagonal_; }

  /// visit(image, sign1, sign2) for a cell of the first rows() and columns() and each of its images: once,
  /// also where some are the cell itself.
  template <typename Visit>
  void each(Index i, Index j, const Visit& visit) const {
    visit(i * n2_ + j, 1.0, 1.0);
    if (!mirrored_) return;
    const double sign = turns_ ? -1.0 : 1.0;
    const Index k = n1_ - 1 - i;
    const Index l = n2_ - 1 - j;
    if (k != i) visit(k * n2_ + j, 1.0, sign);
    if (l != j) visit(i * n2_ + l, sign, 1.0);
    if (k != i && l != j) visit(k * n2_ + l, sign, sign);
  }

 private:
  Index n1_;
  Index n2_;
  bool mirrored_;
  bool diagonal_;
  bool turns_;  ///< tractions go round the axis, as (-x2, x1) does
};

/// Points of a cell along each side, over which averages are taken. An edge of the traction is a square
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
    const int row = k / points;
    const int column = k % points;
    const double part1 = (row + 0.5) / points - 0.5;
    const double part2 = (column + 0.5) / points - 0.5;
    const auto [q1, q2] = shear_at(oracle, y1 + part1 * grid.h1, y2 + part2 * grid.h2, size_at);
    sum[0] += q1;
    sum[1] += q2;
  }
  return {sum[0] / (points * points), sum[1] / (points * points)};
}

/// Against averages over the cells near an edge, and values at the centres elsewhere, where the two differ by
/// h^2/24 times the traction's second derivatives.
TractionError traction_error(const ArrayXd& traction, const Oracle& oracle, const solver::Grid& grid,
                             const ExactFields& fields) {
  if (!oracle.shear) return {};
  const double diagonal = std::hypot(grid.h1, grid.h2);
  const ShearBesideEdges beside_edges(oracle, 2.0 * diagonal, std::min(grid.h1, grid.h2) / kTableSteps);
  const double width = kEdgeBand * std::sqrt(grid.cell_area());
  const bool slips = oracle.stick_radius < oracle.contact_radius;
  const Images images(oracle, grid);
  const auto distinct = solver::Sweep::whole(images.rows() * images.columns());
  const auto sums = distinct.sum<TractionNorms>([&](Index first, Index last, TractionNorms& sum) {
    for (Index k = first; k < last; ++k) {
      const Index i = k / images.columns();
      const Index j = k % images.columns();
      const Index cell = i * grid.n2 + j;
      const double radius = fields.radius[cell];
      const auto is_within = [&](double distance, double edge) { return std::abs(radius - edge) <= distance; };
      const std::array<double, 2> centre{fields.traction[cell], fields.traction[cell + grid.cells()]};
      std::array<double, 2> mean = centre;
      const bool near_edge = is_within(diagonal, oracle.stick_radius) || is_within(diagonal, oracle.contact_radius);
      if (near_edge) {
        mean = mean_over_cell(oracle, grid, grid.x1(i) - oracle.place.centre[0], grid.x2(j) - oracle.place.centre[1],
                              beside_edges);
      }
      Norms& region = slips && is_within(width, oracle.stick_radius) ? sum.stick_edge
                      : is_within(width, oracle.contact_radius)      ? sum.contact_edge
                      : radius < oracle.stick_radius                 ? sum.inside
                                                                     : sum.outside;
      const double size = std::sqrt(centre[0] * centre[0] + centre[1] * centre[1]);
      const double mean_size = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1]);
      images.each(i, j, [&](Index image, double sign1, double sign2) {
        const auto off = [&](const std::array<double, 2>& exact) {
          const double d1 = traction[image] - sign1 * exact[0];
          const double d2 = traction[image + grid.cells()] - sign2 * exact[1];
          return std::sqrt(d1 * d1 + d2 * d2);
        };
        sum.exact_at_centres.add(size);
        sum.exact_averaged.add(mean_size);
        const double at_centre = off(centre);
        const double difference = near_edge ? off(mean) : at_centre;
        sum.at_centres.add(at_centre);
        sum.averaged.add(difference);
        region.add(difference);
      });
    }
  });
  return {
      .at_centres = field_error(sums.at_centres, sums.exact_at_centres),
      .averaged = field_error(sums.averaged, sums.exact_averaged),
      .stick_edge = field_error(sums.stick_edge, sums.exact_averaged),
      .contact_edge = field_error(sums.contact_edge, sums.exact_averaged),
      .inside = field_error(sums.inside, sums.exact_averaged),
      .outside = field_error(sums.outside, sums.exact_averaged),
  };
}

FieldError pressure_error(const ArrayXd& pressure, const ArrayXd& exact) {
  const auto norms_of = [&](const auto& size_at) {
    return solver::Sweep::whole(exact.size()).sum<Norms>([&](Index first, Index last, Norms& sum) {
      for (Index i = first; i < last; ++i) {
        if (std::isfinite(exact[i])) sum.add(size_at(i));
      }
    });
  };
  return field_error(norms_of([&](Index i) { return std::abs(pressure[i] - exact[i]); }),
                     norms_of([&](Index i) { return exact[i]; }));
}

FieldError sharpened_error(const std::vector<SharpenedCell>& cells, const solver::Solution& solution,
                           const ExactFields& exact) {
  const Index count = solution.grid.cells();
  auto next = cells.begin();
  Norms off;
  Norms size;
  for (Index cell = 0; cell < count; ++cell) {
    std::array<double, 2> q{solution.traction[cell], solution.traction[cell + count]};
    if (next != cells.end() && next->cell == cell) q = (next++)->traction;
    const std::array<double, 2> e{exact.traction[cell], exact.traction[cell + count]};
    off.add(std::hypot(q[0] - e[0], q[1] - e[1]));
    size.add(std::hypot(e[0], e[1]));
  }
  return field_error(off, size);
}

}  // namespace

double relative_error(double value, double exact) { return std::isfinite(exact) ? value / exact - 1.0 : NAN; }

ExactFields exact_fields(const Oracle& oracle, const solver::Grid& grid) {
  const Index cells = grid.cells();
  ExactFields exact{ArrayXd(cells), ArrayXd(cells), ArrayXd(2 * cells)};
  const Images images(oracle, grid);
  ArrayXd sizes(images.rows() * images.columns());  // of the shear tractions
  for (Index i = 0; i < images.rows(); ++i) {
    for (Index j = 0; j < images.columns(); ++j) {
      const double y1 = grid.x1(i) - oracle.place.centre[0];
      const double y2 = grid.x2(j) - oracle.place.centre[1];
      const bool found = images.diagonal() && j < i;
      const Index twin = j * grid.n2 + i;
      const double radius = found ? exact.radius[twin] : oracle.radius(y1, y2);
      const double pressure = found ? exact.pressure[twin] : oracle.pressure(radius);
      double& size = sizes[i * images.columns() + j];
      const auto [q1, q2] = shear_at(oracle, y1, y2, [&](double place) {
        return size = found ? sizes[j * images.columns() + i] : oracle.traction(place);
      });
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

TractionError traction_error(const ArrayXd& traction, const Oracle& oracle, const solver::Grid& grid) {
  return traction_error(traction, oracle, grid, exact_fields(oracle, grid));
}

FieldError pressure_error(const ArrayXd& pressure, const Oracle& oracle, const solver::Grid& grid) {
  return pressure_error(pressure, exact_fields(oracle, grid).pressure);
}

Errors compare(const solver::Solution& solution, const Oracle& oracle) {
  const solver::ThreadPool threads(solution.threads);
  const bool fields = solution.detail == solver::Detail::all;
  // sharpened() needs two fields while it runs: before the exact fields exist, so that peak memory stays.
  const Sharpened sharp = fields && oracle.shear ? sharpened(solution) : Sharpened{};
  const ExactFields exact = fields ? exact_fields(oracle, solution.grid) : ExactFields{};
  return {
      .twist = relative_error(solution.twist_angle, oracle.twist_angle),
      .moment = relative_error(solution.moment, oracle.moment),
      .moment_limit = relative_error(solution.moment_limit, oracle.friction.moment_limit),
      .stick_radius = relative_error(solution.stick_radius, oracle.stick_radius),
      .stick_ratio = relative_error(solution.stick_radius / solution.contact_radius, oracle.state.stick_ratio),
      .displacement = relative_difference(solution.displacement, oracle.displacement),
      .dissipated = relative_error(solution.dissipated, oracle.dissipated),
      .stick_radius_counted = relative_error(solution.stick_radius_counted, oracle.stick_radius),
      .contact_radius = relative_error(solution.contact_radius, oracle.contact_radius),
      .peak_pressure = relative_error(solution.peak_pressure, oracle.normal.peak_pressure),
      .traction = fields ? traction_error(solution.traction, oracle, solution.grid, exact) : TractionError{},
      .sharpened = fields && oracle.shear ? sharpened_error(sharp.cells, solution, exact) : FieldError{},
      .kept = sharp.kept,
      .pressure = fields ? pressure_error(solution.pressure, exact.pressure) : FieldError{},
  };
}

}  // namespace slipstick::convergence
