#include "solver/contact/certificate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/newton/admissible.hpp"

namespace slipstick::solver {

Eigen::ArrayXd dot_products(const Eigen::ArrayXd& v, const Eigen::ArrayXd& w) {
  const Eigen::Index cells = v.size() / 2;
  return v.head(cells) * w.head(cells) + v.tail(cells) * w.tail(cells);
}

Eigen::ArrayXd norms(const Eigen::ArrayXd& vectors) { return dot_products(vectors, vectors).sqrt(); }

Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound,
                    const Eigen::ArrayXd& rotation, double moment, const std::array<double, 2>& force,
                    double least_eigenvalue) {
  const Eigen::Index cells = friction_bound.size();
  const auto& q = field.traction;
  const double total_friction = friction_bound.sum();
  if (total_friction == 0.0 && (q == 0.0).all()) return {};  // no friction, no traction: nothing to violate
  const double energy = 0.5 * (q * field.elastic_displacement).sum();
  const Eigen::ArrayXd gap = dot_products(q, field.slip) + friction_bound * norms(field.slip);
  const double limit = (friction_bound * norms(rotation)).sum();

  Certificate certificate{};
  const double total_gap = gap.sum();
  certificate.gap = total_gap == 0.0 ? 0.0 : total_gap / energy;
  const FrictionDiscs discs(friction_bound);
  const double energy_error = discs.energy_error(q, field.slip, least_eigenvalue);
  certificate.energy_error = energy_error == 0.0 ? 0.0 : energy_error / energy;
  const double rounding = discs.gap_rounding(field.slip, field.elastic_displacement);
  certificate.rounding = rounding == 0.0 ? 0.0 : rounding / energy;
  const double imbalance = std::abs((q * rotation).sum() - moment);
  certificate.moment =
      imbalance == 0.0 ? 0.0 : imbalance / limit;  // one cell on the axis: the limit is 0 too
  certificate.force =
      std::hypot(q.head(cells).sum() - force[0], q.tail(cells).sum() - force[1]) / total_friction;
  const Eigen::ArrayXd size = norms(q);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < cells; ++i) {
    // Outside the contact any traction at all is beyond every bound.
    const double ratio = friction_bound[i] > 0.0 ? size[i] / friction_bound[i]
                         : size[i] == 0.0        ? 0.0
                                                 : std::numeric_limits<double>::infinity();
    worst = ratio <= worst ? worst : ratio;  // keeps NaN
    if (std::isnan(worst)) break;
  }
  certificate.friction_bound = worst - 1.0;
  return certificate;
}

std::string beyond(const Certificate& certificate, const CertificateBounds& bounds) {
  if (!is_certified(certificate.gap, certificate.rounding, bounds.gap)) {
    return fmt::format("gap / energy is {:.3g}, allowed: {:.3g}", certificate.gap, bounds.gap);
  }
  const struct {
    const char* name;
    double value;
    double bound;
  } members[] = {{"the moment's error", certificate.moment, bounds.moment},
                 {"the force's error", certificate.force, bounds.force},
                 {"|q| above mu p", certificate.friction_bound, bounds.friction_bound}};
  for (const auto& [name, value, bound] : members) {
    if (!(value <= bound)) return fmt::format("{} is {:.3g}, allowed: {:.3g}", name, value, bound);
  }
  return "";
}

SlipDirection slip_direction(const Eigen::ArrayXd& traction, const Eigen::ArrayXd& slip) {
  const Eigen::Index cells = traction.size() / 2;
  const Eigen::ArrayXd size = norms(slip);
  const double noticeable = kNoticeableSlip * size.maxCoeff<Eigen::PropagateNaN>();
  const Eigen::ArrayXd along = -dot_products(traction, slip);
  SlipDirection direction{};
  double weight = 0.0;
  for (Eigen::Index i = 0; i < cells; ++i) {
    if (size[i] == 0.0) continue;
    const double across = traction[i] * slip[i + cells] - traction[i + cells] * slip[i];
    const double angle = std::atan2(std::abs(across), along[i]) * 180.0 / std::numbers::pi;
    direction.mean += size[i] * angle;
    weight += size[i];
    if (size[i] >= noticeable) direction.max = std::max(direction.max, angle);
  }
  if (weight > 0.0) direction.mean /= weight;
  if (std::isnan(weight) || std::isnan(direction.mean)) direction.mean = direction.max = std::nan("");
  return direction;
}

}  // namespace slipstick::solver
