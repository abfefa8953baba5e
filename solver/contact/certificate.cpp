#include "solver/contact/certificate.hpp"

#include <fmt/core.h>

#include <numbers>

#include "solver/grid/motion_field.hpp"
#include "solver/grid/sweep.hpp"
#include "solver/newton/admissible.hpp"

namespace slipstick::solver {

Eigen::ArrayXd dot_products(const Eigen::ArrayXd& v, const Eigen::ArrayXd& w) {
  const Eigen::Index cells = v.size() / 2;
  return v.head(cells) * w.head(cells) + v.tail(cells) * w.tail(cells);
}

Eigen::ArrayXd norms(const Eigen::ArrayXd& vectors) { return dot_products(vectors, vectors).sqrt(); }

namespace {

/// The largest of values, as a sum; NaN stays.
struct Largest {
  double value = 0.0;
  Largest& operator+=(const Largest& other) {
    value = other.value <= value || std::isnan(value) ? value : other.value;
    return *this;
  }
};

/// Several sums over cells, and a largest value.
template <std::size_t N>
struct SumsAndLargest {
  std::array<double, N> sums{};
  Largest largest;

  SumsAndLargest& operator+=(const SumsAndLargest& other) {
    sums += other.sums;
    largest += other.largest;
    return *this;
  }
};

/// all: every cell; discs: of the friction bound. Rotation: a field, or a MotionField.
template <class Rotation>
Certificate certificate_of(const Sweep& all, const FrictionDiscs& discs, const TractionField& field,
                           const Eigen::ArrayXd& friction_bound, const Rotation& rotation, double moment,
                           const std::array<double, 2>& force, double least_eigenvalue, const Inherited& before) {
  const Eigen::Index cells = friction_bound.size();
  const Eigen::ArrayXd& q = field.traction;
  const Eigen::ArrayXd& u = field.elastic_displacement;
  const Eigen::ArrayXd& s = field.slip;
  using Sums = SumsAndLargest<7>;
  const auto [sums, worst] = all.sum<Sums>([&](Index first, Index last, Sums& sum) {
    const Index n = last - first;
    const auto bound = friction_bound.segment(first, n);
    const auto q1 = q.segment(first, n);
    const auto q2 = q.segment(first + cells, n);
    const auto s1 = s.segment(first, n);
    const auto s2 = s.segment(first + cells, n);
    const auto t1 = rotation.segment(first, n);
    const auto t2 = rotation.segment(first + cells, n);
    const auto size = (q1.square() + q2.square()).sqrt();
    // Outside the contact any traction exceeds every bound.
    const auto beyond = (size == 0.0).select(0.0, std::numeric_limits<double>::infinity() + 0.0 * size);
    const double worst = (bound > 0.0).select(size / bound, beyond).template maxCoeff<Eigen::PropagateNaN>();
    const double gap = (q1 * s1 + q2 * s2 + bound * (s1.square() + s2.square()).sqrt()).sum();
    const double all_slips = (bound * (t1.square() + t2.square()).sqrt()).sum();
    sum += {{0.5 * (q1 * u.segment(first, n) + q2 * u.segment(first + cells, n)).sum(), gap, bound.sum(), all_slips,
             (q1 * t1 + q2 * t2).sum(), q1.sum(), q2.sum()},
            {worst}};
  });
  // q.Kq/2, the gap, the sum of mu p, the moment if all slips, moment and force of the tractions; max |q|/(mu p) or NaN
  const auto [elastic, gap, friction, limit, carried, force1, force2] = sums;
  // No friction, no traction: nothing to violate.
  if (friction == 0.0 && worst.value == 0.0) return {};

  Certificate certificate{};
  // NaN and negative values stay.
  const double energy = before.energy > 0.0 && elastic <= before.energy ? before.energy : elastic;
  certificate.energy = energy;
  certificate.gap = gap == 0.0 ? 0.0 : gap / energy;
  const double energy_error = discs.energy_error(q, s, least_eigenvalue);
  certificate.energy_error = energy_error == 0.0 ? 0.0 : energy_error / energy;
  double rounding = discs.gap_rounding(s, u);
  // Slip is then K q - K q_before - motion; K q_before is no larger than the three other fields together.
  if (before.motion > 0.0) rounding = 2.0 * rounding + kGapUnits * before.motion * friction;
  certificate.rounding = rounding == 0.0 ? 0.0 : rounding / energy;
  const double imbalance = std::abs(carried - moment);
  certificate.moment = imbalance == 0.0 ? 0.0 : imbalance / limit;  // one cell on the axis: the limit is 0 too
  certificate.force = std::hypot(force1 - force[0], force2 - force[1]) / friction;
  certificate.friction_bound = worst.value - 1.0;
  return certificate;
}

}  // namespace

Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound, const Eigen::ArrayXd& rotation,
                    double moment, const std::array<double, 2>& force, double least_eigenvalue) {
  return certificate_of(Sweep::whole(friction_bound.size()), FrictionDiscs(friction_bound), field, friction_bound,
                        rotation, moment, force, least_eigenvalue, {});
}

Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound, const Grid& grid, double moment,
                    const std::array<double, 2>& force, double least_eigenvalue, const Inherited& before) {
  return certificate_of(Sweep::whole(grid), FrictionDiscs(grid, friction_bound), field, friction_bound,
                        MotionField(grid, 0.0, 0.0, 1.0), moment, force, least_eigenvalue, before);
}

std::string violated_bounds(const Certificate& certificate, const CertificateBounds& bounds) {
  if (!is_certified(certificate.gap, certificate.rounding, bounds.gap)) {
    return fmt::format("gap / energy is {:.3g}, allowed: {:.3g}", certificate.gap, bounds.gap);
  }
  if (certificate.gap > bounds.gap && !(certificate.energy_error <= bounds.gap)) {
    return fmt::format(
        "rounding keeps gap / energy at {:.3g}, and its bound of second order at {:.3g}, allowed: "
        "{:.3g}",
        certificate.gap, certificate.energy_error, bounds.gap);
  }
  const struct {
    const char* name;
    double value;
    double bound;
  } members[] = {{"the moment's error", certificate.moment, bounds.moment},
                 {"the force's error", certificate.force, bounds.force},
                 {"|q| above its bound", certificate.friction_bound, bounds.friction_bound}};
  for (const auto& [name, value, bound] : members) {
    if (!(value <= bound)) return fmt::format("{} is {:.3g}, allowed: {:.3g}", name, value, bound);
  }
  return "";
}

SlipDirection slip_direction(const Eigen::ArrayXd& traction, const Eigen::ArrayXd& slip) {
  const Index cells = traction.size() / 2;
  const Sweep all = Sweep::whole(cells);
  const auto size = [&](Index i) { return std::sqrt(slip[i] * slip[i] + slip[i + cells] * slip[i + cells]); };
  const auto largest = all.sum<Largest>([&](Index first, Index last, Largest& sum) {
    for (Index i = first; i < last; ++i) sum += {size(i)};
  });
  const double noticeable = kNoticeableSlip * largest.value;
  using Sums = SumsAndLargest<2>;
  const auto [sums, widest] = all.sum<Sums>([&](Index first, Index last, Sums& sum) {
    for (Index i = first; i < last; ++i) {
      const double weight = size(i);
      if (weight == 0.0) continue;
      const double along = -(traction[i] * slip[i] + traction[i + cells] * slip[i + cells]);
      const double across = traction[i] * slip[i + cells] - traction[i + cells] * slip[i];
      const double angle = std::atan2(std::abs(across), along) * 180.0 / std::numbers::pi;
      sum += {{weight, weight * angle}, {weight >= noticeable ? angle : 0.0}};
    }
  });
  const auto [weights, angles] = sums;
  if (std::isnan(weights) || std::isnan(angles)) return {std::nan(""), std::nan("")};
  return {weights > 0.0 ? angles / weights : 0.0, widest.value};
}

}  // namespace slipstick::solver
