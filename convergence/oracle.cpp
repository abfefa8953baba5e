#include "convergence/oracle.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "analytic/cycle.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/spence.hpp"
#include "analytic/tangential_history.hpp"

namespace slipstick::convergence {
namespace {

/// Why a surface has no exact solution here; empty if it has one.
std::string obstacle(const std::vector<solver::Surface>& surfaces) {
  using solver::Shape;
  if (surfaces.size() > 1) return "no exact solution is known here for several shapes";
  const solver::Surface& surface = surfaces.front();
  const char* detail = nullptr;
  if (surface.shape == Shape::height_map || surface.shape == Shape::roughness) detail = "";
  if (surface.shape == Shape::ellipsoid && surface.radius_1 != surface.radius_2) {
    detail = " with two different radii";
  }
  if (surface.shape == Shape::flat_punch && surface.inner_radius > 0.0) detail = " with an inner radius";
  if (detail == nullptr) return "";
  return fmt::format("no exact solution is known here for shape = \"{}\"{}", to_string(surface.shape),
                     detail);
}

double mismatch(const solver::Material& m) {
  return (1.0 - 2.0 * m.poisson_ratio) * (1.0 + m.poisson_ratio) / m.young_modulus;
}

/// Whether the pressure moves the two surfaces sideways by different amounts, and the scene wants to know.
bool is_coupled(const solver::Scene& scene) {
  return scene.coupling != solver::Coupling::none && mismatch(scene.upper) != mismatch(scene.lower);
}

/// Why no theory holds for a scene; empty if one may.
std::string obstacle(const solver::Scene& scene) {
  std::string of_surface = obstacle(scene.surfaces);
  if (!of_surface.empty()) return of_surface;
  if (scene.pressure == solver::PressureModel::file) return "the pressure comes from a file";
  if (!(scene.friction > 0.0)) return "without friction there is no traction";
  return "";
}

/// Moduli of the pair: 1/E* = sum of (1 - nu^2)/E, and 1/G = sum of 2 (1 + nu)/E.
struct Moduli {
  double effective;
  double shear;
};
Moduli moduli(const solver::Scene& scene) {
  const auto sum_of = [&](auto numerator) {
    return numerator(scene.upper.poisson_ratio) / scene.upper.young_modulus +
           numerator(scene.lower.poisson_ratio) / scene.lower.young_modulus;
  };
  return {.effective = 1.0 / sum_of([](double nu) { return 1.0 - nu * nu; }),
          .shear = 1.0 / sum_of([](double nu) { return 2.0 * (1.0 + nu); })};
}

/// The contact before torsion.
analytic::PressedContact press(const solver::Surface& surface, double load, double effective_modulus) {
  using solver::Shape;
  const auto press_as = [&](const std::string& profile, const std::vector<double>& shape) {
    return analytic::press(profile, {load, effective_modulus, shape});
  };
  switch (surface.shape) {
    case Shape::sphere:
      return press_as("hertz", {surface.radius});
    case Shape::ellipsoid:  // of equal radii
      return press_as("hertz", {surface.radius_1});
    case Shape::cone:
      return press_as("cone", {surface.slope});
    case Shape::flat_punch:
      return press_as("flat_punch", {surface.radius});
    case Shape::rounded_punch:
      return press_as("rounded_punch", {surface.flat_radius, surface.corner_radius});
    case Shape::power:
      return press_as(fmt::format("power:{}", surface.exponent), {surface.coefficient});
    case Shape::height_map:
    case Shape::roughness:
      break;
  }
  throw std::logic_error("a shape without an exact solution");
}

/// The highest pressure over p0: on the axis, at the edge, or, under what is flatter than a paraboloid, at
/// the one maximum between them (golden section).
double peak_of(const analytic::Profile& profile) {
  constexpr int steps = 80;  // 0.618^80 is below the rounding of a radius
  double low = 0.0;
  double high = 1.0;
  for (int step = 0; step < steps; ++step) {
    const double part = (high - low) / (1.0 + std::numbers::phi);
    const bool rises = profile.pressure(low + part) < profile.pressure(high - part);
    (rises ? low : high) = rises ? low + part : high - part;
  }
  return std::max({profile.pressure(0.0), profile.pressure(high), profile.pressure(1.0)});
}

/// What makes dimensionless moments and twists those of the scene.
struct TorsionUnits {
  double moment;  ///< mu W a
  double twist;   ///< mu W/(G a^2)
};

/// What the theories share: an indenter's contact, and the pair's moduli.
class Indentation {
 public:
  explicit Indentation(const solver::Scene& scene)
      : surface_(scene.surfaces.front()), pair_(moduli(scene)), friction_(scene.friction) {}

  const Moduli& pair() const { return pair_; }
  double friction() const { return friction_; }

  /// The contact, without shear.
  Oracle pressed(double load) const {
    const auto [named, contact] = press(surface_, load, pair_.effective);
    Oracle oracle{};
    oracle.profile = named.profile;
    oracle.centre = surface_.at;
    oracle.contact_radius = contact.contact_radius;
    oracle.reference_pressure = contact.reference_pressure;
    oracle.peak_pressure = contact.reference_pressure * peak_of(*named.profile);
    oracle.approach = contact.approach;
    oracle.friction = friction_;
    oracle.moment_limit = named.profile->moment_limit() * friction_ * load * contact.contact_radius;
    oracle.stick_radius = contact.contact_radius;
    oracle.state.stick_ratio = 1.0;
    return oracle;
  }

 private:
  solver::Surface surface_;
  Moduli pair_;
  double friction_;
};

/// Torsion under a constant normal load: first loading, then Masing's rule.
class TorsionHistory final : public ExactHistory {
 public:
  TorsionHistory(const Indentation& indentation, double normal_load)
      : contact_(indentation.pressed(normal_load)),
        units_{.moment = contact_.friction * normal_load * contact_.contact_radius,
               .twist = contact_.friction * normal_load /
                        (indentation.pair().shear * contact_.contact_radius * contact_.contact_radius)},
        history_(*contact_.profile) {}

 private:
  OracleAnswer follow(const solver::Step& step) override {
    try {
      return {first_ ? load_first(step.torsion) : load_on(step.torsion), ""};
    } catch (const std::domain_error& error) {
      return {std::nullopt,
              fmt::format("beyond the range of the exact solution: {} (M_lim = {:.17g} N m, mu W/(G a^2) = "
                          "{:.6g} rad)",
                          error.what(), contact_.moment_limit, units_.twist),
              true};
    }
  }

  double ratio_of(const solver::TorsionLoad& load) const {
    return load.moment_ratio ? *load.moment_ratio : *load.moment / contact_.moment_limit;
  }

  /// The ratio that turns the contact on to a twist, by bisection: 1 or -1 where none does.
  double ratio_at(double twist) const {
    double low = -1.0;
    double high = 1.0;
    for (double middle = 0.0; low < middle && middle < high; middle = std::midpoint(low, high)) {
      analytic::LoadingHistory turned = history_;
      turned.load_to(middle);
      (turned.state().twist < twist ? low : high) = middle;
    }
    return high == 1.0 ? high : low;
  }

  Oracle load_first(const solver::TorsionLoad& load) {
    first_ = false;
    const double sign = std::copysign(1.0, load.twist ? *load.twist : ratio_of(load));
    Oracle oracle = contact_;
    oracle.state = load.twist ? analytic::from_twist(std::abs(*load.twist) / units_.twist, *contact_.profile)
                              : analytic::from_moment_ratio(std::abs(ratio_of(load)), *contact_.profile);
    history_.load_to(sign * oracle.state.moment_ratio);
    dissipated_ = history_.state().dissipated;
    oracle.dissipated = dissipated_ * energy_unit();
    oracle.shear = [scale = sign * oracle.friction * oracle.reference_pressure, state = oracle.state,
                    profile = oracle.profile, a = oracle.contact_radius](double radius) {
      return scale * analytic::traction(state, radius / a, *profile);
    };
    for (double* const value : {&oracle.state.moment, &oracle.state.twist, &oracle.state.moment_ratio}) {
      *value *= sign;
    }
    return in_units(oracle);
  }

  Oracle load_on(const solver::TorsionLoad& load) {
    history_.load_to(load.twist ? ratio_at(*load.twist / units_.twist) : ratio_of(load));
    const analytic::CycleState state = history_.state();
    Oracle oracle = contact_;
    oracle.state = {.moment_ratio = state.moment_ratio,
                    .moment_deficit = 1.0 - std::abs(state.moment_ratio),
                    .stick_ratio = state.stick_ratio,
                    .stick_complement = 1.0 - state.stick_ratio,
                    .twist = state.twist,
                    .moment = state.moment,
                    .tangent_stiffness = state.tangent_stiffness};
    oracle.dissipated = (state.dissipated - dissipated_) * energy_unit();
    dissipated_ = state.dissipated;
    oracle.shear = [scale = oracle.friction * oracle.reference_pressure, history = history_,
                    a = oracle.contact_radius](double radius) {
      return scale * history.traction(radius / a);
    };
    return in_units(oracle);
  }

  Oracle in_units(Oracle oracle) const {
    oracle.moment = oracle.state.moment * units_.moment;
    oracle.twist_angle = oracle.state.twist * units_.twist;
    oracle.stick_radius = oracle.state.stick_ratio * oracle.contact_radius;
    return oracle;
  }

  double energy_unit() const { return units_.moment * units_.twist; }

  Oracle contact_;
  TorsionUnits units_;
  analytic::LoadingHistory history_;
  double dissipated_ = 0.0;
  bool first_ = true;
};

/// A tangential force along one line, under any normal loads.
class ForceHistory final : public ExactHistory {
 public:
  /// first_load: the scale of loads.
  ForceHistory(Indentation indentation, double first_load, double exponent,
               const std::array<double, 2>& direction)
      : indentation_(std::move(indentation)),
        direction_(direction),
        load_(first_load),
        reference_(indentation_.pressed(load_)),
        history_(analytic::SelfSimilarIndenter(exponent)) {}

 private:
  OracleAnswer follow(const solver::Step& step) override {
    const double unit = indentation_.friction() * load_;
    const double force = step.force[0] * direction_[0] + step.force[1] * direction_[1];
    try {
      const double normal = *step.normal / load_;
      // The solver's steps bring a rising load before the force.
      if (normal > history_.state().normal_load) history_.load_to(normal, history_.state().force);
      history_.load_to(normal, force / unit);
    } catch (const std::domain_error& error) {
      return {std::nullopt, fmt::format("beyond the range of the exact solution: {}", error.what()), true};
    }
    const analytic::tangential::HistoryState state = history_.state();
    const double a = reference_.contact_radius;
    const double length = unit / (indentation_.pair().shear * a);
    Oracle oracle = indentation_.pressed(*step.normal);
    oracle.force = step.force;
    oracle.displacement = {state.displacement * length * direction_[0],
                           state.displacement * length * direction_[1]};
    oracle.stick_radius = state.stick_radius * a;
    oracle.state.stick_ratio = state.stick_radius / state.contact_radius;
    oracle.dissipated = (state.dissipated - dissipated_) * unit * length;
    dissipated_ = state.dissipated;
    oracle.direction = direction_;
    oracle.shear = [scale = indentation_.friction() * reference_.reference_pressure, history = history_,
                    a](double radius) { return scale * history.traction(radius / a); };
    return {oracle, ""};
  }

  Indentation indentation_;
  std::array<double, 2> direction_;
  double load_;
  Oracle reference_;
  analytic::tangential::TangentialHistory history_;
  double dissipated_ = 0.0;
};

/// Dissimilar bodies pressed together, more and more: the stick ratio is the same throughout.
class FrictionalIndentation final : public ExactHistory {
 public:
  explicit FrictionalIndentation(const solver::Scene& scene)
      : indentation_(scene), full_(scene.coupling == solver::Coupling::full) {
    const double beta = 0.5 * indentation_.pair().effective * (mismatch(scene.lower) - mismatch(scene.upper));
    stick_ratio_ = full_ ? analytic::spence_contact(scene.friction, beta).stick_ratio
                         : analytic::goodman_stick_radius(scene.friction, beta).ratio;
  }

 private:
  OracleAnswer follow(const solver::Step& step) override {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    Oracle oracle = indentation_.pressed(*step.normal);
    oracle.state.stick_ratio = stick_ratio_;
    oracle.stick_radius = stick_ratio_ * oracle.contact_radius;
    oracle.dissipated = unknown;
    if (full_) {  // shear has its part in the pressure
      oracle.contact_radius = oracle.stick_radius = oracle.approach = oracle.peak_pressure = unknown;
      oracle.reference_pressure = oracle.moment_limit = unknown;
    }
    return {oracle, ""};
  }

  Indentation indentation_;
  bool full_;
  double stick_ratio_ = 0.0;
};

class NoTheory final : public ExactHistory {
 public:
  explicit NoTheory(std::string reason) : reason_(std::move(reason)) {}

 private:
  OracleAnswer follow(const solver::Step&) override { return {std::nullopt, reason_}; }

  std::string reason_;
};

bool without_torsion(const solver::Step& step) {
  const solver::TorsionLoad& load = step.torsion;
  return load.moment_ratio.value_or(load.moment.value_or(load.twist.value_or(0.0))) == 0.0;
}

bool without_force(const solver::Step& step) {
  return !step.displacement && step.force == std::array<double, 2>{};
}

/// Of gaps like r^n.
std::optional<double> gap_exponent(const solver::Surface& surface) {
  using solver::Shape;
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::ellipsoid:
      return 2.0;
    case Shape::cone:
      return 1.0;
    case Shape::flat_punch:
      return std::numeric_limits<double>::infinity();
    case Shape::power:
      return surface.exponent;
    default:
      return std::nullopt;
  }
}

/// Of a direction given by two numbers.
constexpr double kRounding = 1e-14;

/// The line along which all forces act, as a unit vector; none if there are several.
std::optional<std::array<double, 2>> line_of_forces(const std::vector<solver::Step>& steps) {
  std::array<double, 2> line{};
  for (const solver::Step& step : steps) {
    const auto& [f1, f2] = step.force;
    const double size = std::hypot(f1, f2);
    if (size == 0.0) continue;
    if (line == std::array<double, 2>{}) line = {f1 / size, f2 / size};
    if (std::abs(line[0] * f2 - line[1] * f1) > kRounding * size) return std::nullopt;
  }
  return line;
}

bool has_no_cross_contraction(const solver::Material& material) {
  return material.poisson_ratio == 0.0 || std::isinf(material.young_modulus);
}

std::unique_ptr<ExactHistory> none(const std::string& reason) { return std::make_unique<NoTheory>(reason); }

std::unique_ptr<ExactHistory> history_under_force(const solver::Scene& scene) {
  const auto exponent = gap_exponent(scene.surfaces.front());
  const auto line = line_of_forces(scene.steps);
  if (std::any_of(scene.steps.begin(), scene.steps.end(), [](const auto& s) { return s.displacement; })) {
    return none("the displacement is imposed, not the force");
  }
  if (!has_no_cross_contraction(scene.upper) || !has_no_cross_contraction(scene.lower)) {
    return none("Cattaneo's and Mindlin's solution is exact only where Poisson's ratios are 0");
  }
  if (!line) return none("no exact solution is known here for forces along several lines");
  if (!exponent) return none("the contact does not stay similar to itself as the load changes");
  return std::make_unique<ForceHistory>(Indentation(scene), *scene.steps.front().normal, *exponent, *line);
}

std::unique_ptr<ExactHistory> history_of_dissimilar(const solver::Scene& scene) {
  const auto& steps = scene.steps;
  const bool pressed_only = std::all_of(steps.begin(), steps.end(), [](const solver::Step& step) {
    return without_torsion(step) && without_force(step);
  });
  const bool growing =
      scene.cycles == 1 && std::is_sorted(steps.begin(), steps.end(),
                                          [](const auto& a, const auto& b) { return *a.normal < *b.normal; });
  if (!pressed_only || !growing || !gap_exponent(scene.surfaces.front())) {
    return none("the pressure's tangential displacement of dissimilar materials enters (contact.coupling)");
  }
  try {
    return std::make_unique<FrictionalIndentation>(scene);
  } catch (const std::exception& error) {
    return none(error.what());
  }
}

}  // namespace

double Oracle::pressure(double radius) const {
  const double ratio = radius / contact_radius;
  if (std::isnan(ratio)) return ratio;
  return ratio < 1.0 ? reference_pressure * profile->pressure(ratio) : 0.0;
}

double Oracle::traction(double radius) const {
  if (!shear) return std::numeric_limits<double>::quiet_NaN();
  return radius < contact_radius ? shear(radius) : 0.0;
}

OracleAnswer ExactHistory::advance(const solver::Step& step) {
  if (left_) return {std::nullopt, "a step before left the range of the exact solution"};
  OracleAnswer answer = follow(step);
  left_ = answer.out_of_range;
  return answer;
}

std::unique_ptr<ExactHistory> exact_history(const solver::Scene& scene) {
  const std::string reason = obstacle(scene);
  if (!reason.empty()) return none(reason);
  if (is_coupled(scene)) return history_of_dissimilar(scene);
  const auto& steps = scene.steps;
  if (!std::all_of(steps.begin(), steps.end(), without_force)) {
    if (std::all_of(steps.begin(), steps.end(), without_torsion)) return history_under_force(scene);
    return none("no exact solution is known here for torsion together with a force");
  }
  const bool constant_load = std::all_of(steps.begin(), steps.end(), [&](const solver::Step& step) {
    return step.normal == steps.front().normal;
  });
  if (!constant_load)
    return none("no exact solution is known here for torsion while the normal load changes");
  return std::make_unique<TorsionHistory>(Indentation(scene), *steps.front().normal);
}

OracleAnswer find_oracle(const solver::Scene& scene) {
  return exact_history(scene)->advance(scene.steps.front());
}

}  // namespace slipstick::convergence
