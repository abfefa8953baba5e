#include "solver/contact/stick_front.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "solver/grid/sweep.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kTurn = 2.0 * std::numbers::pi;

// Lengths are in cells from here on, and (i, j) is the centre of that cell.
constexpr double kMinStickCells = 12.0;
constexpr double kMarch = 0.125;    // step along a ray across the cells
constexpr double kStaircase = 2.0;  // what the counted front may be off between two rays
constexpr double kLateral = 3.5;    // cells up to here on both sides of a ray take part in its fit
constexpr double kWidestAngle = 0.4;
constexpr double kFarthest = 24.0;  // cells further from the front than this take part in no fit
constexpr double kLargestShift = 2.0;
constexpr int kPasses = 4;  // each measures from the front that the last one has found
constexpr double kBesideQuadrant =
    kWidestAngle + 0.1;  // of a quadrant's rays, cells that a fit or a check needs

/// What part of the slip ring is fitted on a ray, from the front, and by which degree in the distance.
struct Window {
  double from;
  double to;
  int degree;
};

/// The mesh blurs the slip for some two cells beyond the front; in narrow rings these are dear. Towards the
/// contact's edge the slip has another expansion. Chosen on the circular contact with 48 to 256 cells across
/// and 0.1 to 0.97 of the limit moment, where each keeps the front within 0.02 cells (0.05 if its radius is
/// but 10 cells). A straight line does for rings that are narrow against the front's own radius; one below 3
/// cells holds too few of them.
Window window(double ring_width, double front) {
  if (ring_width >= 24.0) return {2.5, std::min(20.0, 0.7 * ring_width), 4};
  if (ring_width >= 12.0) return {2.0, 0.7 * ring_width, 3};
  if (ring_width >= 5.0) return {1.5, 0.8 * ring_width, 2};
  if (ring_width < 0.15 * front) return {1.0, ring_width - 1.0, 1};
  return {0.0, 0.0, 1};
}

/// A slipping cell as a ray sees it: distances from the reference front, straightened, and from the ray, and
/// |s|^(2/3).
struct Sample {
  double along;
  double across;
  double psi;
};

/// Distance where a polynomial of the window's degree, with terms in y, x y and y^2 for what changes across
/// the ray, is zero on the ray; NaN where the samples do not determine it or it does not rise there. By the
/// normal equations, which are well conditioned in lengths over those of the window.
double fitted_root(const std::vector<Sample>& samples, const Window& depth) {
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
  for (const auto& [along, across, psi] : samples) {
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

/// Counting is never further off than this, in cells: an answer that differs by more rests on slip that began
/// elsewhere, or is no root of the law.
constexpr double kLargestCorrection = 0.5;

class FrontFinder {
 public:
  FrontFinder(const Grid& grid, const ArrayXd& friction_bound, const ArrayXd& slip, const ArrayXd& stick)
      : grid_(grid), all_(Sweep::whole(grid)), bound_(friction_bound), slip_(slip), stick_(stick) {}

  StickFront run() {
    StickFront front;
    stick_cells_ = static_cast<double>(all_.sum<Index>([&](Index first, Index last, Index& count) {
      for (Index cell = first; cell < last; ++cell) count += bound_[cell] > 0.0 && stick_[cell] != 0.0;
    }));
    front.counted_radius = front.radius = radius(stick_cells_);
    if (!finite()) {
      front.radius = std::nan("");
      front.why_counted = "slip, stick or friction bound is not finite";
      return front;
    }
    front.why_counted = why_not_rays();
    if (front.why_counted.empty()) fit(front);
    return front;
  }

 private:
  bool finite() const {
    return all_.sum<Index>([&](Index first, Index last, Index& count) {
      for (Index cell = first; cell < last; ++cell) {
        const bool slips_finitely = !(bound_[cell] > 0.0) || std::isfinite(slip_square(cell));
        count += !(std::isfinite(bound_[cell]) && std::isfinite(stick_[cell]) && slips_finitely);
      }
    }) == 0;
  }

  double slip_square(Index cell) const {
    const double s1 = slip_[cell];
    const double s2 = slip_[cell + grid_.cells()];
    return s1 * s1 + s2 * s2;
  }

  double radius(double cells) const { return std::sqrt(cells * grid_.cell_area() / std::numbers::pi); }

  /// Prepares the rays; or says why there are none.
  std::string why_not_rays() {
    if (stick_cells_ == 0.0) return "nothing sticks";
    if (stick_cells_ == static_cast<double>((bound_ > 0.0).count())) return "everything sticks";
    if (stick_cells_ < kMinStickCells) return fmt::format("only {} cells stick", stick_cells_);
    find_centroid();
    mirrored_ = is_mirrored();
    cast_rays();
    return collect_slipping_cells() ? "" : "the stick area is not one patch that its centroid sees all of";
  }

  void fit(StickFront& front) {
    ArrayXd r = counted_;
    Index fitted = 0;
    for (int pass = 0; pass < kPasses; ++pass) {
      reference_ = smoothed(r);
      for (SlippingCell& cell : slipping_) cell.reference = cell.rays.of(reference_);
      r = counted_;
      const Index distinct = distinct_rays();
      ArrayXd shifts(distinct);
      in_parts(ThreadPool::available(), distinct, [&](int, Index first, Index last) {
        for (Index ray = first; ray < last; ++ray) shifts[ray] = fitted_root(samples_near(ray), ring(ray));
      });
      fitted = 0;
      for (Index ray = 0; ray < distinct; ++ray) {
        if (!(std::abs(shifts[ray]) <= kLargestShift)) continue;
        for (const Index image : images(ray)) r[image] = reference_[ray] + shifts[ray];
        fitted += static_cast<Index>(images(ray).size());
      }
    }
    if (fitted > 0) front.radius = radius(0.5 * r.square().sum() * kTurn / static_cast<double>(rays_));
    front.fitted = static_cast<double>(fitted) / static_cast<double>(rays_);
    if (fitted < rays_) {
      front.why_counted =
          fmt::format("slip ring too narrow, or no root near by, on {} of {} rays", rays_ - fitted, rays_);
    }
    const double cell = std::sqrt(grid_.cell_area());
    if (!(std::abs(front.radius - front.counted_radius) <= kLargestCorrection * cell)) {
      front.radius = front.counted_radius;
      front.why_counted =
          "outside the front the slip does not grow as where slip has begun there and gone on";
    }
  }

  bool in_contact(Index i, Index j) const {
    return i >= 0 && j >= 0 && i < grid_.n1 && j < grid_.n2 && bound_[i * grid_.n2 + j] > 0.0;
  }
  bool sticks(Index i, Index j) const { return in_contact(i, j) && stick_[i * grid_.n2 + j] != 0.0; }

  template <typename Visit>
  void for_contact_cells(const Visit& visit) const {
    for (Index i = 0; i < grid_.n1; ++i) {
      for (Index j = 0; j < grid_.n2; ++j) {
        if (in_contact(i, j)) visit(i, j);
      }
    }
  }

  void find_centroid() {
    for_contact_cells([&](Index i, Index j) {
      if (!sticks(i, j)) return;
      centre_i_ += static_cast<double>(i) / stick_cells_;
      centre_j_ += static_cast<double>(j) / stick_cells_;
    });
  }

  /// Whether both axes are mirrors of all fields, to the last bit: of a front that was solved as a quadrant,
  /// a quarter of the rays says all.
  bool is_mirrored() const {
    const auto alike = [&](Index a, Index b) {
      return bound_[a] == bound_[b] && stick_[a] == stick_[b] && slip_square(a) == slip_square(b);
    };
    return all_.sum<Index>([&](Index first, Index last, Index& count) {
      const Index opposite = grid_.cells() - last - first;  // the row on the other side
      for (Index cell = first; cell < last; ++cell) {
        count +=
            bound_[cell] > 0.0 && !(alike(cell, cell + opposite) && alike(cell, first + last - 1 - cell));
      }
    }) == 0;
  }

  /// The first ones, which show all the others by their images.
  Index distinct_rays() const { return mirrored_ ? rays_ / 4 : rays_; }

  /// The ray, and its mirror images where there are some.
  std::vector<Index> images(Index ray) const {
    if (!mirrored_) return {ray};
    return {ray, rays_ / 2 - 1 - ray, rays_ / 2 + ray, rays_ - 1 - ray};
  }

  double angle(Index ray) const {
    return kTurn * (static_cast<double>(ray) + 0.5) / static_cast<double>(rays_);
  }

  /// Lengths on each ray to where stick and contact end, by the cells that it crosses.
  void cast_rays() {
    double longest = 1.0;
    for_contact_cells([&](Index i, Index j) {
      if (sticks(i, j)) longest = std::max(longest, radius_of(i, j));
    });
    rays_ = 4 * static_cast<Index>(std::ceil(0.25 * kTurn * longest));  // no answer changes by a quarter turn
    counted_.resize(rays_);
    edge_.resize(rays_);
    in_parts(ThreadPool::available(), distinct_rays(), [&](int, Index first, Index last) {
      for (Index ray = first; ray < last; ++ray) cast_ray(ray);
    });
  }

  void cast_ray(Index ray) {
    const double c = std::cos(angle(ray));
    const double s = std::sin(angle(ray));
    const auto march = [&](double r, const auto& inside) {
      while (inside(nearest(centre_i_ + r * c), nearest(centre_j_ + r * s))) r += kMarch;
      return r;
    };
    const double front = march(0.0, [&](Index i, Index j) { return sticks(i, j); });
    const double edge = march(front, [&](Index i, Index j) { return in_contact(i, j); });
    for (const Index image : images(ray)) {
      edge_[image] = edge;
      counted_[image] = std::max(0.0, front - 0.5 * kMarch);
    }
  }

  /// Values on the rays, linear in the angle between them.
  struct BetweenRays {
    Index below, above;
    double part;
    double of(const ArrayXd& values) const { return values[below] + part * (values[above] - values[below]); }
  };
  BetweenRays between_rays(double theta) const {
    const double at = theta / kTurn * static_cast<double>(rays_) - 0.5;
    const double below = std::floor(at);
    const auto ray = static_cast<Index>(below) + rays_;
    return {ray % rays_, (ray + 1) % rays_, at - below};
  }

  /// The cell, or -1 and less: a ray leaves the grid by one cell at a time.
  static Index nearest(double at) { return static_cast<Index>(at + 1.5) - 1; }

  /// From the centroid: the distance, and the angle from 0 to a turn.
  double radius_of(Index i, Index j) const {
    const double x = static_cast<double>(i) - centre_i_;
    const double y = static_cast<double>(j) - centre_j_;
    return std::sqrt(x * x + y * y);
  }
  double angle_of(Index i, Index j) const {
    const double theta = std::atan2(static_cast<double>(j) - centre_j_, static_cast<double>(i) - centre_i_);
    return theta < 0.0 ? theta + kTurn : theta;
  }

  struct SlippingCell {
    double theta;
    double r;
    double psi;
    BetweenRays rays;
    double reference;  ///< the reference front at this angle
  };

  /// Those that some window may take, by angle. False if a cell is not on the side of the counted front that
  /// its state says. Cells far from the front need no angle.
  bool collect_slipping_cells() {
    const double nearest_front = counted_.minCoeff();
    const double farthest_front = counted_.maxCoeff();
    bool star_shaped = true;
    for_contact_cells([&](Index i, Index j) {
      const double r = radius_of(i, j);
      const bool stuck = sticks(i, j);
      if (stuck ? r <= nearest_front : r > farthest_front + kFarthest) return;
      const double theta = angle_of(i, j);
      if (mirrored_ && theta > 0.25 * kTurn + kBesideQuadrant && theta < kTurn - kBesideQuadrant) return;
      const BetweenRays rays = between_rays(theta);
      const double beyond = r - rays.of(counted_);
      if (stuck ? beyond > kStaircase : beyond < -kStaircase) star_shaped = false;
      if (stuck || beyond > kFarthest) return;
      slipping_.push_back({theta, r, std::cbrt(slip_square(i * grid_.n2 + j)), rays, 0.0});
    });
    std::ranges::sort(slipping_, {}, &SlippingCell::theta);
    return star_shaped;
  }

  /// Means over seven rays, which take the staircase off the counted front.
  ArrayXd smoothed(const ArrayXd& r) const {
    constexpr Index kHalf = 3;
    ArrayXd mean = ArrayXd::Zero(rays_);
    for (Index ray = 0; ray < rays_; ++ray) {
      for (Index k = -kHalf; k <= kHalf; ++k) mean[ray] += r[(ray + k + rays_) % rays_];
    }
    return mean / (2 * kHalf + 1);
  }

  Window ring(Index ray) const { return window(edge_[ray] - reference_[ray], reference_[ray]); }

  /// Radii are scaled by the reference front, so that it becomes a circle: what is left to fit across the ray
  /// is small on slender stick areas too.
  std::vector<Sample> samples_near(Index ray) const {
    const double front = reference_[ray];
    const double half = std::min(kLateral / front, kWidestAngle);
    const Window depth = ring(ray);
    std::vector<Sample> samples;
    for (const double turn : {-kTurn, 0.0, kTurn}) {  // the sector may reach over the angle's jump
      const double middle = angle(ray) + turn;
      auto cell = std::ranges::lower_bound(slipping_, middle - half, {}, &SlippingCell::theta);
      for (; cell != slipping_.end() && cell->theta <= middle + half; ++cell) {
        const double straight = cell->r * front / cell->reference;
        if (straight - front < depth.from || straight - front > depth.to) continue;
        samples.push_back({straight - front, (cell->theta - middle) * front, cell->psi});
      }
    }
    return samples;
  }

  const Grid& grid_;
  Sweep all_;  // row by row
  const ArrayXd& bound_;
  const ArrayXd& slip_;
  const ArrayXd& stick_;
  double stick_cells_ = 0.0;
  double centre_i_ = 0.0, centre_j_ = 0.0;  // centroid of the stick area
  bool mirrored_ = false;
  Index rays_ = 0;
  ArrayXd counted_, edge_;  // on each ray, where stick and contact end
  ArrayXd reference_;       // a smooth front, from which the windows are measured
  std::vector<SlippingCell> slipping_;
};

}  // namespace

StickFront find_stick_front(const Grid& grid, const ArrayXd& friction_bound, const ArrayXd& slip,
                            const ArrayXd& stick) {
  if (friction_bound.size() != grid.cells() || stick.size() != grid.cells() ||
      slip.size() != 2 * grid.cells()) {
    throw std::invalid_argument("stick front: fields of another size than the grid's");
  }
  if (grid.quadrant) throw std::invalid_argument("stick front: allowed: whole grids, no quadrants");
  return FrontFinder(grid, friction_bound, slip, stick).run();
}

}  // namespace slipstick::solver
