#include "solver/contact/stick_front.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <numbers>
#include <stdexcept>

#include "solver/grid/sweep.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kTurn = 2.0 * std::numbers::pi;

// Lengths are in cells from here on, and (i, j) is the centre of that cell.
constexpr double kMinStickCells = 12.0;
constexpr double kMarch = 0.125;    // step along a ray across the cells
constexpr double kStaircase = 2.0;  // error of the counted front between two rays
constexpr double kLateral = 3.5;    // the fit takes cells up to here on both sides of a ray
constexpr double kWidestAngle = 0.4;
constexpr double kFarthest = 24.0;  // cells further from the front than this take part in no fit
constexpr double kLargestShift = 2.0;
constexpr int kPasses = 4;                              // each measures distances from the last one's front
constexpr double kAroundQuadrant = kWidestAngle + 0.1;  // of a quadrant's rays, cells that a fit or a check needs

/// The part of the slip ring next to the front that is fitted on a ray, and the degree in the distance.
struct Window {
  double from;
  double to;
  int degree;
};

/// The mesh blurs the slip for about two cells beyond the front; narrow rings cannot spare two cells. Near
/// the contact's edge the slip has another expansion. Chosen on the circular contact with 48 to 256 cells
/// across and 0.1 to 0.97 of the limit moment, where each window keeps the front within 0.02 cells (0.05 for
/// a radius of 10 cells). A straight line suffices for rings that are narrow against the front's radius; a
/// ring of less than 3 cells holds too few samples.
Window window(double ring_width, double front) {
  if (ring_width >= 24.0) return {2.5, std::min(20.0, 0.7 * ring_width), 4};
  if (ring_width >= 12.0) return {2.0, 0.7 * ring_width, 3};
  if (ring_width >= 5.0) return {1.5, 0.8 * ring_width, 2};
  if (ring_width < 0.15 * front) return {1.0, ring_width - 1.0, 1};
  return {0.0, 0.0, 1};
}

/// A slipping cell in a ray's coordinates: distance from the straightened reference front, distance from the
/// ray, and |s|^(2/3).
struct Sample {
  double along;
  double across;
  double psi;
};

/// Root on the ray of a polynomial of the window's degree in x, with terms in y, x y and y^2 across the ray;
/// NaN if the samples do not determine it or it does not rise there. The normal equations are well
/// conditioned in lengths over the window's.
double fitted_root(const std::vector<Sample> &samples, const Window &depth) {
  constexpr int kMaxTerms = 8;
  using Terms = Eigen::Matrix<double, kMaxTerms, 1>;
  const Index terms = depth.degree + 4;
  if (static_cast<Index>(samples.size()) < 2 * terms) return std::nan("");
  const double middle = 0.5 * (depth.from + depth.to);
  const double half = 0.5 * (depth.to - depth.from);
  Eigen::Matrix<double, kMaxTerms, kMaxTerms> matrix;
  matrix.setZero();
  matrix.diagonal().tail(kMaxTerms - terms).setOnes();
  Terms right = Terms::Zero();
  for (const auto &[along, across, psi] : samples) {
    const double x = (along - middle) / half;
    const double y = across / kLateral;
    Terms row = Terms::Zero();
    double power = 1.0;
    for (int p = 0; p <= depth.degree; ++p, power *= x) row[p] = power;
    row.segment<3>(depth.degree + 1) << y, x * y, y * y;
    for (int term = 0; term < terms; ++term) matrix.col(term) += row[term] * row;
    right += psi * row;
  }
  const Terms c = matrix.ldlt().solve(right);
  double x = -middle / half;
  for (int step = 0; step < 20; ++step) {
    double value = 0.0;
    double slope = 0.0;
    for (int p = depth.degree; p >= 0; --p) {
      slope = slope * x + value;
      value = value * x + c[p];
    }
    if (!(slope > 0.0)) return std::nan("");
    x -= value / slope;
  }
  return middle + half * x;
}

/// Largest error of counting, in cells: a fit that differs by more rests on slip that did not begin at the front.
constexpr double kLargestCorrection = 0.5;

/// A contact's cells: which press, slip and stick.
class FrontCells {
 public:
  FrontCells(const Grid &grid, const ArrayXd &friction_bound, const ArrayXd &slip, const ArrayXd &stick)
      : grid_(grid), all_(Sweep::whole(grid)), bound_(friction_bound), slip_(slip), stick_(stick) {}

  bool finite() const {
    return none([&](Index cell) {
      const bool slips_finitely = !(bound_[cell] > 0.0) || std::isfinite(slip_square(cell));
      return !(std::isfinite(bound_[cell]) && std::isfinite(stick_[cell]) && slips_finitely);
    });
  }
  double stick_cells() const {
    return static_cast<double>(count([&](Index cell) { return bound_[cell] > 0.0 && stick_[cell] != 0.0; }));
  }
  double contact_cells() const { return static_cast<double>((bound_ > 0.0).count()); }

  double cell_area() const { return grid_.cell_area(); }
  /// The radius of a circle of this area, in cells.
  double radius(double cells) const { return std::sqrt(cells * cell_area() / std::numbers::pi); }

  bool in_contact(Index i, Index j) const {
    return i >= 0 && j >= 0 && i < grid_.n1 && j < grid_.n2 && bound_[i * grid_.n2 + j] > 0.0;
  }
  bool sticks(Index i, Index j) const { return in_contact(i, j) && stick_[i * grid_.n2 + j] != 0.0; }
  double slip_square(Index i, Index j) const { return slip_square(i * grid_.n2 + j); }

  /// All cells of the grid, and those next to it.
  template <typename Visit>
  void for_all(const Visit &visit) const {
    for (Index i = -1; i <= grid_.n1; ++i) {
      for (Index j = -1; j <= grid_.n2; ++j) visit(i, j);
    }
  }

  /// True if both axes are mirrors of all fields, to the last bit, as after a solve on a quadrant: then a
  /// quarter of the rays suffices.
  bool is_mirrored() const {
    const auto alike = [&](Index a, Index b) {
      return bound_[a] == bound_[b] && stick_[a] == stick_[b] && slip_square(a) == slip_square(b);
    };
    return none([&](Index cell) {
      if (!(bound_[cell] > 0.0)) return false;
      const Index first = cell / grid_.n2 * grid_.n2;           // of its row, and
      const Index opposite = grid_.cells() - grid_.n2 - first;  // of the row on the other side
      return !(alike(cell, opposite + cell - first) && alike(cell, first + grid_.n2 - 1 - (cell - first)));
    });
  }

 private:
  double slip_square(Index cell) const {
    const double s1 = slip_[cell];
    const double s2 = slip_[cell + grid_.cells()];
    return s1 * s1 + s2 * s2;
  }
  template <typename Is>
  Index count(const Is &is) const {
    return all_.sum<Index>([&](Index first, Index last, Index &sum) {
      for (Index cell = first; cell < last; ++cell) sum += is(cell);
    });
  }
  template <typename Is>
  bool none(const Is &is) const {
    return count(is) == 0;
  }

  const Grid &grid_;
  Sweep all_;  ///< row by row
  const ArrayXd &bound_;
  const ArrayXd &slip_;
  const ArrayXd &stick_;
};

/// Rays from the centroid of the stick area, and where stick and contact end on them.
class Rays {
 public:
  Rays(const FrontCells &cells, double stick_cells) : cells_(cells), mirrored_(cells.is_mirrored()) {
    Index sum_i = 0;
    Index sum_j = 0;
    cells.for_all([&](Index i, Index j) {
      if (!cells.sticks(i, j)) return;
      sum_i += i;
      sum_j += j;
    });
    centre_i_ = static_cast<double>(sum_i) / stick_cells;
    centre_j_ = static_cast<double>(sum_j) / stick_cells;
    double longest = 1.0;
    double shortest = std::numeric_limits<double>::infinity();
    cells.for_all([&](Index i, Index j) {
      if (cells.sticks(i, j))
        longest = std::max(longest, square_of_radius(i, j));
      else
        shortest = std::min(shortest, square_of_radius(i, j));
    });
    // No answer changes by a quarter turn.
    count_ = 4 * static_cast<Index>(std::ceil(0.25 * kTurn * std::sqrt(longest)));
    // Up to there rays cross only sticking cells: no point of a cell is further than 1 from its centre.
    start_ = std::max(0.0, std::floor(std::sqrt(shortest)) - 1.0);
    counted_.resize(count_);
    edge_.resize(count_);
    in_parts(ThreadPool::available(), distinct(), [&](int, Index first, Index last) {
      for (Index ray = first; ray < last; ++ray) cast(ray);
    });
  }

  Index count() const { return count_; }
  bool mirrored() const { return mirrored_; }
  /// Lengths on each ray to where stick and contact end, by the cells that it crosses.
  const ArrayXd &counted() const { return counted_; }
  const ArrayXd &edge() const { return edge_; }

  /// The first rays, whose mirror images are all the others.
  Index distinct() const { return mirrored_ ? count_ / 4 : count_; }
  /// The ray, and its mirror images where there are some.
  std::vector<Index> images(Index ray) const {
    if (!mirrored_) return {ray};
    return {ray, count_ / 2 - 1 - ray, count_ / 2 + ray, count_ - 1 - ray};
  }
  double angle(Index ray) const { return kTurn * (static_cast<double>(ray) + 0.5) / static_cast<double>(count_); }

  /// Values on the rays, linear in the angle between them.
  struct Between {
    Index below, above;
    double part;
    double of(const ArrayXd &values) const { return values[below] + part * (values[above] - values[below]); }
  };
  Between between(double theta) const {
    const double at = theta / kTurn * static_cast<double>(count_) - 0.5;
    const double below = std::floor(at);
    const auto ray = static_cast<Index>(below) + count_;
    return {ray % count_, (ray + 1) % count_, at - below};
  }

  /// From the centroid: the distance, and the angle from 0 to a turn.
  double radius_of(Index i, Index j) const { return std::sqrt(square_of_radius(i, j)); }
  double angle_of(Index i, Index j) const {
    const double theta = std::atan2(static_cast<double>(j) - centre_j_, static_cast<double>(i) - centre_i_);
    return theta < 0.0 ? theta + kTurn : theta;
  }

  /// Means over seven rays, which smooth the staircase of the counted front.
  ArrayXd smoothed(const ArrayXd &r) const {
    constexpr Index kHalf = 3;
    ArrayXd mean = ArrayXd::Zero(count_);
    for (Index ray = 0; ray < count_; ++ray) {
      for (Index k = -kHalf; k <= kHalf; ++k) mean[ray] += r[(ray + k + count_) % count_];
    }
    return mean / (2 * kHalf + 1);
  }

 private:
  double square_of_radius(Index i, Index j) const {
    const double x = static_cast<double>(i) - centre_i_;
    const double y = static_cast<double>(j) - centre_j_;
    return x * x + y * y;
  }
  void cast(Index ray) {
    const double c = std::cos(angle(ray));
    const double s = std::sin(angle(ray));
    const auto march = [&](double r, const auto &inside) {
      while (inside(nearest(centre_i_ + r * c), nearest(centre_j_ + r * s))) r += kMarch;
      return r;
    };
    const double front = march(start_, [&](Index i, Index j) { return cells_.sticks(i, j); });
    const double edge = march(front, [&](Index i, Index j) { return cells_.in_contact(i, j); });
    for (const Index image : images(ray)) {
      edge_[image] = edge;
      counted_[image] = std::max(0.0, front - 0.5 * kMarch);
    }
  }
  /// The cell, or -1 and less: a ray leaves the grid by one cell at a time.
  static Index nearest(double at) { return static_cast<Index>(at + 1.5) - 1; }

  const FrontCells &cells_;
  bool mirrored_;
  double centre_i_ = 0.0, centre_j_ = 0.0;  ///< centroid of the stick area
  double start_ = 0.0;                      ///< of the march along each ray
  Index count_ = 0;
  ArrayXd counted_, edge_;
};

/// The front on each ray, fitted to the slip of the cells beyond it.
class FrontFit {
 public:
  FrontFit(const FrontCells &cells, const Rays &rays) : rays_(rays) { collect_slipping_cells(cells); }

  /// True if each cell is on the side of the counted front that belongs to its state.
  bool star_shaped() const { return star_shaped_; }

  void run(const FrontCells &cells, StickFront &front) {
    const Index count = rays_.count();
    ArrayXd r = rays_.counted();
    Index fitted = 0;
    for (int pass = 0; pass < kPasses; ++pass) {
      reference_ = rays_.smoothed(r);
      for (SlippingCell &cell : slipping_) cell.reference = cell.rays.of(reference_);
      r = rays_.counted();
      const Index distinct = rays_.distinct();
      ArrayXd shifts(distinct);
      in_parts(ThreadPool::available(), distinct, [&](int, Index first, Index last) {
        for (Index ray = first; ray < last; ++ray) shifts[ray] = fitted_root(samples_near(ray), ring(ray));
      });
      fitted = 0;
      for (Index ray = 0; ray < distinct; ++ray) {
        if (!(std::abs(shifts[ray]) <= kLargestShift)) continue;
        for (const Index image : rays_.images(ray)) r[image] = reference_[ray] + shifts[ray];
        fitted += static_cast<Index>(rays_.images(ray).size());
      }
    }
    if (fitted > 0) front.radius = cells.radius(0.5 * r.square().sum() * kTurn / static_cast<double>(count));
    front.fitted = static_cast<double>(fitted) / static_cast<double>(count);
    if (fitted < count) {
      front.why_counted =
          fmt::format("slip ring too narrow, or no root near by, on {} of {} rays", count - fitted, count);
    }
    if (!(std::abs(front.radius - front.counted_radius) <= kLargestCorrection * std::sqrt(cells.cell_area()))) {
      front.radius = front.counted_radius;
      front.why_counted =
          "outside the front the slip does not grow as it does if slip began at the front and continued";
    }
  }

 private:
  struct SlippingCell {
    double theta;
    double r;
    double psi;
    Rays::Between rays;
    double reference;  ///< the reference front at this angle
  };

  /// The cells that a window may contain, sorted by angle. Cells far from the front are skipped.
  void collect_slipping_cells(const FrontCells &cells) {
    const double nearest_front = rays_.counted().minCoeff();
    const double farthest_front = rays_.counted().maxCoeff();
    cells.for_all([&](Index i, Index j) {
      if (!cells.in_contact(i, j)) return;
      const double r = rays_.radius_of(i, j);
      const bool stuck = cells.sticks(i, j);
      if (stuck ? r <= nearest_front : r > farthest_front + kFarthest) return;
      const double theta = rays_.angle_of(i, j);
      if (rays_.mirrored() && theta > 0.25 * kTurn + kAroundQuadrant && theta < kTurn - kAroundQuadrant) return;
      const Rays::Between rays = rays_.between(theta);
      const double beyond = r - rays.of(rays_.counted());
      if (stuck ? beyond > kStaircase : beyond < -kStaircase) star_shaped_ = false;
      if (stuck || beyond > kFarthest) return;
      slipping_.push_back({theta, r, std::cbrt(cells.slip_square(i, j)), rays, 0.0});
    });
    std::ranges::sort(slipping_, {}, &SlippingCell::theta);
  }

  Window ring(Index ray) const { return window(rays_.edge()[ray] - reference_[ray], reference_[ray]); }

  /// Radii are scaled by the reference front, so that it becomes a circle and changes across the ray are
  /// small, also on slender stick areas.
  std::vector<Sample> samples_near(Index ray) const {
    const double front = reference_[ray];
    const double half = std::min(kLateral / front, kWidestAngle);
    const Window depth = ring(ray);
    std::vector<Sample> samples;
    for (const double turn : {-kTurn, 0.0, kTurn}) {  // the sector may reach over the angle's jump
      const double middle = rays_.angle(ray) + turn;
      auto cell = std::ranges::lower_bound(slipping_, middle - half, {}, &SlippingCell::theta);
      for (; cell != slipping_.end() && cell->theta <= middle + half; ++cell) {
        const double straight = cell->r * front / cell->reference;
        if (straight - front < depth.from || straight - front > depth.to) continue;
        samples.push_back({straight - front, (cell->theta - middle) * front, cell->psi});
      }
    }
    return samples;
  }

  const Rays &rays_;
  ArrayXd reference_;  ///< a smooth front, from which the windows are measured
  std::vector<SlippingCell> slipping_;
  bool star_shaped_ = true;
};

/// Fits the front, or returns the reason why it is only counted.
std::string fit_front(const FrontCells &cells, double stick_cells, StickFront &front) {
  if (stick_cells == 0.0) return "nothing sticks";
  if (stick_cells == cells.contact_cells()) return "everything sticks";
  if (stick_cells < kMinStickCells) return fmt::format("only {} cells stick", stick_cells);
  const Rays rays(cells, stick_cells);
  FrontFit fit(cells, rays);
  if (!fit.star_shaped()) return "the stick area is not one patch that its centroid sees all of";
  fit.run(cells, front);
  return front.why_counted;
}

}  // namespace

StickFront find_stick_front(const Grid &grid, const ArrayXd &friction_bound, const ArrayXd &slip,
                            const ArrayXd &stick) {
  if (friction_bound.size() != grid.cells() || stick.size() != grid.cells() || slip.size() != 2 * grid.cells()) {
    throw std::invalid_argument("stick front: fields of another size than the grid's");
  }
  if (grid.quadrant) throw std::invalid_argument("stick front: allowed: whole grids, no quadrants");
  const FrontCells cells(grid, friction_bound, slip, stick);
  const double stick_cells = cells.stick_cells();
  StickFront front;
  front.counted_radius = front.radius = cells.radius(stick_cells);
  if (!cells.finite()) {
    front.radius = std::nan("");
    front.why_counted = "slip, stick or friction bound is not finite";
    return front;
  }
  front.why_counted = fit_front(cells, stick_cells, front);
  return front;
}

}  // namespace slipstick::solver
