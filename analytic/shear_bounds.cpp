#include "analytic/shear_bounds.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

/// A disc of constant bound 1 around a stick area of radius c: its radius, and sqrt(radius^2 - c^2).
struct Disc {
  double radius;
  double root;
};

/// integral_c^rho s^3 (-H'(s)) ds.
double moment_of_slip(const Disc& disc, double c) {
  const double cube = disc.radius * disc.radius * disc.radius;
  return cube / 2 * std::atan2(disc.root, c) + disc.radius / 2 * c * disc.root;
}

/// integral_0^c of the same: rho^3/2 (t - sin t cos t) with t = arcsin(c/rho), a series where t is small.
double moment_within(const Disc& disc, double c) {
  constexpr double kSmall = 0.5;
  constexpr int kTerms = 16;  // (2 t)^(2 n)/(2 n + 3)! at t = 1/2 is below an ulp
  const double t = std::atan2(c, disc.root);
  const double cube = disc.radius * disc.radius * disc.radius;
  if (t > kSmall) return cube / 2 * t - disc.radius / 2 * c * disc.root;
  double sum = 1;
  for (int n = kTerms; n > 0; --n) sum = 1 - 4 * t * t / ((2 * n + 2) * (2 * n + 3)) * sum;
  const double ratio = disc.radius * t;
  return ratio * ratio * ratio / 3 * sum;
}

/// (2/pi) arctan(r sqrt(rho^2 - c^2)/(rho sqrt(c^2 - r^2))); inward = c - r.
double stick_traction_of(const Disc& disc, StickRadius c, double r, double inward) {
  return 2 / pi * std::atan2(r * disc.root, disc.radius * std::sqrt(inward) * std::sqrt(c.ratio + r));
}

class ConstantBound final : public Profile {
 public:
  ConstantBound()
      : Profile({.name = "constant", .reference_pressure = "constant bound", .load = pi, .moment_limit = 2.0 / 3}) {}

  double pressure(double) const override { return 1; }
  double twist_integral(StickRadius c) const override { return std::asinh(disc(c).root / c.ratio); }
  double twist_slope(StickRadius c) const override { return 1 / disc(c).root; }

  MomentShare moment_share(StickRadius c) const override {
    const double slip = 4 / pi * moment_of_slip(disc(c), c.ratio);
    const double stick = 4 / pi * moment_within(disc(c), c.ratio);
    return slip < 0.5 ? MomentShare{.excess = slip, .deficit = 1 - slip}
                      : MomentShare{.excess = 1 - stick, .deficit = stick};
  }

  double stick_traction(StickRadius c, double radius, double inward) const override {
    return stick_traction_of(disc(c), c, radius, inward);
  }

 private:
  static Disc disc(StickRadius c) { return {1, std::sqrt(c.complement * (1 + c.ratio))}; }
};

/// f = min(sqrt(1 - r^2), cap)^n. The disc of the bound v = p^n has the radius sqrt(1 - p^2).
class BoundUnderHertz final : public Profile {
 public:
  BoundUnderHertz(std::string name, std::string reference, double cap, double exponent)
      : BoundUnderHertz(std::move(name), std::move(reference), Shape{cap, exponent}) {}

  double pressure(double radius) const override {
    return std::pow(std::min(std::sqrt((1 - radius) * (1 + radius)), shape_.cap), shape_.exponent);
  }

  double twist_integral(StickRadius c) const override {
    return shape_.sum(c, c.ratio, 0, [&](const Disc& disc, double) { return std::asinh(disc.root / c.ratio); });
  }
  double twist_slope(StickRadius c) const override {
    return shape_.sum(c, c.ratio, -1, [](const Disc& disc, double cosine) { return disc.radius / cosine; });
  }
  /// Hertz's pressure.
  double punch_density(StickRadius s) const override { return s.ratio; }
  std::vector<double> kinks() const override {
    if (shape_.cap == 1) return {};
    return {std::sqrt((1 - shape_.cap) * (1 + shape_.cap))};
  }

  MomentShare moment_share(StickRadius c) const override {
    const double slip =
        shape_.sum(c, c.ratio, 0, [&](const Disc& disc, double) { return moment_of_slip(disc, c.ratio); }) / all_;
    if (slip < 0.5) return {.excess = slip, .deficit = 1 - slip};
    const double stick =
        (shape_.sum(c, c.ratio, 0, [&](const Disc& disc, double) { return moment_within(disc, c.ratio); }) +
         pi / 4 * shape_.cubes_within(c.ratio)) /
        all_;
    return {.excess = 1 - stick, .deficit = stick};
  }

  double stick_traction(StickRadius c, double radius, double inward) const override {
    const double pole = std::sqrt(inward) * std::sqrt(c.ratio + radius);
    return shape_.sum(c, pole, 0, [&](const Disc& disc, double) { return stick_traction_of(disc, c, radius, inward); });
  }

 private:
  struct Shape {
    double cap;
    double exponent;

    /// The sum over all discs larger than the stick area, of f(disc, cosine) p_c^power, where p = p_c sin(t)
    /// and cosine = cos(t): the substitution removes the square root at p = p_c. Panels shrink towards t = 0,
    /// where the measure goes like t^(n - 1) and all else like a constant and t^2; near t = pi/2 they grow
    /// with the distance from there and from where f is singular, at p_c cos(t) = +-i pole.
    template <class Function>
    double sum(StickRadius c, double pole, double power, const Function& f) const {
      constexpr double kMiddle = 1;
      constexpr double kFirst = 0x1p-30;  // its square is no part of the sum
      constexpr double kGrowth = 5;       // 20 points follow t^(n - 1) so far to all digits
      constexpr double kReach = 2;
      const double at_front = std::sqrt(c.complement * (1 + c.ratio));  // p_c
      const double highest = std::min(at_front, cap);
      const double beyond = std::sqrt((at_front - highest) * (at_front + highest));
      const auto at = [&](double sine, double cosine) {
        const double root = at_front * cosine;
        const double measure = exponent == 1 ? 1 : exponent * std::pow(sine, exponent - 1);
        return measure * cosine * f(Disc{std::hypot(c.ratio, root), root}, cosine);
      };
      const double end = beyond > 0 ? std::min(std::atan2(highest, beyond), kMiddle) : kMiddle;
      const double first = kFirst * end;
      double total = at(first, 1) * first / exponent;
      for (double low = first, high = 0; low < end; low = high) {
        high = std::min(end, kGrowth * low);
        total += gsl::gauss_legendre([&](double t) { return at(std::sin(t), std::cos(t)); }, low, high);
      }
      for (double low = std::atan2(beyond, highest), high = 0; low < pi / 2 - kMiddle; low = high) {
        high = std::min(pi / 2 - kMiddle, low + kReach * std::hypot(low, pole / at_front));
        total += gsl::gauss_legendre([&](double d) { return at(std::cos(d), std::sin(d)); }, low, high);
      }
      return std::pow(at_front, exponent + power) * total;
    }

    /// integral of rho^3 over the bounds of the discs that lie within the stick area; by their radii.
    double cubes_within(double c) const {
      constexpr int kPanels = 8;
      const double flat = std::sqrt((1 - cap) * (1 + cap));
      double total = 0;
      for (int k = 0; k < kPanels && c > flat; ++k) {
        const double low = flat + (c - flat) * k / kPanels;
        total += gsl::gauss_legendre(
            [&](double rho) {
              return exponent * rho * rho * rho * rho * std::pow((1 - rho) * (1 + rho), exponent / 2 - 1);
            },
            low, low + (c - flat) / kPanels);
      }
      return total;
    }
  };

  BoundUnderHertz(std::string name, std::string reference, const Shape& shape)
      : BoundUnderHertz(std::move(name), std::move(reference), shape, of_all(shape, 2), of_all(shape, 3)) {}
  BoundUnderHertz(std::string name, std::string reference, const Shape& shape, double squares, double cubes)
      : Profile({.name = std::move(name),
                 .reference_pressure = std::move(reference),
                 .load = pi * squares,
                 .moment_limit = 2.0 / 3 * cubes / squares}),
        shape_(shape),
        all_(pi / 4 * cubes) {}

  /// The sum of rho^power over all discs.
  static double of_all(const Shape& shape, double power) {
    constexpr StickRadius kNearlyNone{.ratio = 1e-100, .complement = 1};
    return shape.sum(kNearlyNone, 1, 0, [&](const Disc& disc, double) { return std::pow(disc.radius, power); });
  }

  Shape shape_;
  double all_;  // integral_0^1 s^3 (-H'(s)) ds
};

}  // namespace

const Profile& constant_bound_profile() {
  static const ConstantBound profile;
  return profile;
}

std::unique_ptr<const Profile> capped_hertz_profile(double cap) {
  if (!(cap > 0 && cap <= 1)) out_of_range("cap", cap, "0 < cap <= 1");
  return std::make_unique<const BoundUnderHertz>(fmt::format("capped:{}", cap), "peak of mu p without the cap", cap, 1);
}

std::unique_ptr<const Profile> power_of_hertz_profile(double exponent) {
  constexpr double kMax = 3;
  if (!(exponent > 0 && exponent <= kMax))
    out_of_range("exponent of the pressure", exponent, fmt::format("0 < n <= {}", kMax));
  return std::make_unique<const BoundUnderHertz>(fmt::format("pressure_power:{}", exponent), "bound at the centre", 1,
                                                 exponent);
}

}  // namespace slipstick::analytic
