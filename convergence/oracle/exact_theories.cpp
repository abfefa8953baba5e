#include "convergence/oracle/exact_theories.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "analytic/cattaneo_mindlin.hpp"
#include "analytic/cycle.hpp"
#include "analytic/indentation.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/spence.hpp"
#include "analytic/tangential_history.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// Moduli of the pair's surface materials: 1/E* = sum of (1 - nu^2)/E, and 1/G = sum of 2 (1 + nu)/E.
struct Moduli {
  double effective;
  double shear;
};
Moduli moduli(const solver::Scene& scene) {
  const solver::Material upper = surface_material(scene.upper);
  const solver::Material lower = surface_material(scene.lower);
  const auto sum_of = [&](auto numerator) {
    return numerator(upper.poisson_ratio) / upper.young_modulus + numerator(lower.poisson_ratio) / lower.young_modulus;
  };
  return {.effective = 1.0 / sum_of([](double nu) { return 1.0 - nu * nu; }),
          .shear = 1.0 / sum_of([](double nu) { return 2.0 * (1.0 + nu); })};
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

/// Relative: the worst error that the tests of analytic/ allow (of a rounded punch), and a few roundings of
/// the scene's units.
constexpr double kUncertainty = 2e-14;
/// Relative, of Spence's stick ratio: ten digits stand still as his integral equations are refined.
constexpr double kSpenceUncertainty = 1e-10;

/// The units of moments and twists, N m and rad; mu W is the friction force.
struct TorsionUnits {
  double moment;  ///< mu W a
  double twist;   ///< mu W/(G a^2)
};

/// An indenter's contact and the pair's moduli, which all theories use.
class Indentation {
 public:
  explicit Indentation(const solver::Scene& scene)
      : source_(scene.source.string()),
        surface_(scene.surfaces.front()),
        pair_(moduli(scene)),
        friction_(scene.contact.friction) {
    if (is_coated(scene)) coated_ = scene;
  }

  const Moduli& pair() const { return pair_; }
  /// mu; its theories hold under Coulomb's law only.
  double friction() const { return friction_.coefficient; }

  /// The contact, without shear.
  Oracle pressed(double load) const {
    const auto [contact, profile, uncertainty] = pressed_shape(load);
    Oracle oracle{};
    oracle.normal.profile = profile;
    oracle.place.centre = surface_.at;
    oracle.contact_radius = contact.contact_radius;
    oracle.normal.reference_pressure = contact.reference_pressure;
    oracle.normal.peak_pressure = contact.reference_pressure * peak_of(*profile);
    oracle.normal.approach = contact.approach;
    // exact_history() has found that there is one.
    const FrictionBound bound = find_friction_bound(friction_, profile, contact.reference_pressure).value();
    const double a = contact.contact_radius;
    oracle.friction.bound = bound.profile;
    oracle.friction.reference_bound = bound.reference;
    oracle.friction.force =
        friction_.is_coulomb() ? friction_.coefficient * load : bound.profile->load() * bound.reference * a * a;
    oracle.friction.moment_limit = bound.profile->moment_limit() * oracle.friction.force * a;
    oracle.stick_radius = contact.contact_radius;
    oracle.state.stick_ratio = 1.0;
    oracle.relative_uncertainty = uncertainty;
    return oracle;
  }

 private:
  /// Throws InputError for a shape that is none in double precision, std::domain_error where a layer has no
  /// exact contact.
  analytic::layered::LayeredContact pressed_shape(double load) const {
    if (coated_) return press_coated(*coated_, load);
    try {
      const ExactShape shape = exact_shape(surface_).value();  // exact_history() has found that there is one
      const auto [named, contact] = analytic::press(shape.profile, {load, pair_.effective, shape.numbers});
      return {contact, named.profile, kUncertainty};
    } catch (const std::domain_error& error) {
      throw solver::InputError(source_, fmt::format("[upper] has no exact contact: {}", error.what()));
    }
  }

  std::string source_;
  solver::Surface surface_;
  Moduli pair_;
  solver::FrictionLaw friction_;
  std::optional<solver::Scene> coated_;
};

/// Torsion under a constant normal load: first loading, then Masing's rule.
class TorsionHistory {
 public:
  TorsionHistory(const Indentation& indentation, double normal_load)
      : contact_(indentation.pressed(normal_load)),
        units_{.moment = contact_.friction.force * contact_.contact_radius,
               .twist = contact_.friction.force /
                        (indentation.pair().shear * contact_.contact_radius * contact_.contact_radius)},
        history_(*contact_.friction.bound) {}

  OracleAnswer operator()(const solver::Step& step) {
    try {
      return {first_ ? load_first(step.torsion) : load_on(step.torsion), ""};
    } catch (const std::domain_error& error) {
      return {std::nullopt,
              fmt::format("beyond the range of the exact solution: {} (M_lim = {:.17g} N m, mu W/(G a^2) = "
                          "{:.6g} rad)",
                          error.what(), contact_.friction.moment_limit, units_.twist),
              true};
    }
  }

 private:
  double ratio_of(const solver::TorsionLoad& load) const {
    const auto ratio = solver::value_if<solver::MomentRatio>(load);
    return ratio ? *ratio : std::get<solver::Moment>(load).value / contact_.friction.moment_limit;
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
    const auto twist = solver::value_if<solver::Twist>(load);
    const double sign = std::copysign(1.0, twist ? *twist : ratio_of(load));
    Oracle oracle = contact_;
    oracle.state = twist ? analytic::from_twist(std::abs(*twist) / units_.twist, *contact_.friction.bound)
                         : analytic::from_moment_ratio(std::abs(ratio_of(load)), *contact_.friction.bound);
    history_.load_to(sign * oracle.state.moment_ratio);
    dissipated_ = history_.state().dissipated;
    oracle.dissipated = dissipated_ * energy_unit();
    oracle.shear = [scale = sign * oracle.friction.reference_bound, state = oracle.state, bound = oracle.friction.bound,
                    a = oracle.contact_radius](double radius) {
      return scale * analytic::traction(state, radius / a, *bound);
    };
    for (double* const value : {&oracle.state.moment, &oracle.state.twist, &oracle.state.moment_ratio}) {
      *value *= sign;
    }
    return in_units(oracle);
  }

  Oracle load_on(const solver::TorsionLoad& load) {
    const auto twist = solver::value_if<solver::Twist>(load);
    history_.load_to(twist ? ratio_at(*twist / units_.twist) : ratio_of(load));
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
    oracle.shear = [scale = oracle.friction.reference_bound, history = history_,
                    a = oracle.contact_radius](double radius) { return scale * history.traction(radius / a); };
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
class ForceHistory {
 public:
  /// first_load: the scale of loads.
  ForceHistory(Indentation indentation, double first_load, double exponent, const std::array<double, 2>& direction)
      : indentation_(std::move(indentation)),
        direction_(direction),
        load_(first_load),
        reference_(indentation_.pressed(load_)),
        indenter_(exponent),
        history_(indenter_) {}

  OracleAnswer operator()(const solver::Step& step) {
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
    const analytic::tangential::HistoryState state = state_under(force / unit);
    const double a = reference_.contact_radius;
    const double length = unit / (indentation_.pair().shear * a);
    Oracle oracle = indentation_.pressed(*step.normal);
    oracle.force = step.force;
    oracle.displacement = {state.displacement * length * direction_[0], state.displacement * length * direction_[1]};
    oracle.stick_radius = state.stick_radius * a;
    oracle.state.stick_ratio = state.stick_radius / state.contact_radius;
    oracle.dissipated = (state.dissipated - dissipated_) * unit * length;
    dissipated_ = history_.state().dissipated;
    oracle.place.direction = direction_;
    oracle.shear = [scale = indentation_.friction() * reference_.normal.reference_pressure, history = history_,
                    a](double radius) { return scale * history.traction(radius / a); };
    return {oracle, ""};
  }

 private:
  /// A first loading has all its digits, however small the force.
  analytic::tangential::HistoryState state_under(double force) {
    analytic::tangential::HistoryState state = history_.state();
    const bool first = std::exchange(first_, false);
    if (!first || state.normal_load != 1.0 || force == 0.0) return state;
    const auto loaded = analytic::tangential::from_force_ratio(std::abs(force), indenter_);
    state.displacement = std::copysign(loaded.displacement, force);
    state.dissipated = 0.25 * analytic::tangential::energy_lost_per_cycle(loaded, indenter_);
    return state;
  }

  Indentation indentation_;
  std::array<double, 2> direction_;
  double load_;
  Oracle reference_;
  analytic::SelfSimilarIndenter indenter_;
  analytic::tangential::TangentialHistory history_;
  bool first_ = true;
  double dissipated_ = 0.0;
};

/// Hertz's elliptic contact under a load, whatever friction does: only gross slip has an exact solution.
Oracle pressed_ellipse_under(double load, const solver::Surface& surface, const Moduli& pair, double friction) {
  const analytic::HertzEllipse contact =
      analytic::hertz_ellipse(load, surface.radius_1, surface.radius_2, pair.effective);
  Oracle oracle{};
  oracle.normal.profile = analytic::find_profile("hertz").profile;
  oracle.place.centre = surface.at;
  oracle.place.axis_ratio = contact.semi_axis_1 / contact.semi_axis_2;
  oracle.place.angle = surface.angle;
  oracle.contact_radius = std::sqrt(contact.semi_axis_1 * contact.semi_axis_2);
  oracle.normal.reference_pressure = contact.peak_pressure;
  oracle.normal.peak_pressure = contact.peak_pressure;
  oracle.normal.approach = contact.approach;
  oracle.friction.bound = oracle.normal.profile;
  oracle.friction.reference_bound = friction * contact.peak_pressure;
  oracle.friction.force = friction * load;
  oracle.friction.moment_limit = oracle.friction.force * contact.friction_arm;
  oracle.relative_uncertainty = kUncertainty;
  return oracle;
}

/// NaN for an imposed twist.
double moment_of(const solver::TorsionLoad& load, double limit) {
  if (std::holds_alternative<solver::Twist>(load)) return NAN;
  const auto moment = solver::value_if<solver::Moment>(load);
  return moment ? *moment : std::get<solver::MomentRatio>(load).value * limit;
}

}  // namespace

double mismatch(const solver::Material& m) {
  return (1.0 - 2.0 * m.poisson_ratio) * (1.0 + m.poisson_ratio) / m.young_modulus;
}

ExactTheory torsion_history(const solver::Scene& scene) {
  return TorsionHistory(Indentation(scene), *scene.steps.front().normal);
}

ExactTheory force_history(const solver::Scene& scene, double gap_exponent, const std::array<double, 2>& direction) {
  return ForceHistory(Indentation(scene), *scene.steps.front().normal, gap_exponent, direction);
}

ExactTheory frictional_indentation(const solver::Scene& scene) {
  const Indentation indentation(scene);
  const bool full = scene.contact.coupling == solver::Coupling::full;
  const double friction = scene.contact.friction.coefficient;
  const double beta = 0.5 * indentation.pair().effective * (mismatch(scene.lower) - mismatch(scene.upper));
  const double stick_ratio = full ? analytic::spence_contact(friction, beta).stick_ratio
                                  : analytic::goodman_stick_radius(friction, beta).ratio;
  return [=](const solver::Step& step) -> OracleAnswer {  // the stick ratio is the same throughout
    Oracle oracle = indentation.pressed(*step.normal);
    oracle.state.stick_ratio = stick_ratio;
    oracle.stick_radius = stick_ratio * oracle.contact_radius;
    oracle.dissipated = NAN;
    if (full) {  // shear has its part in the pressure
      oracle.relative_uncertainty = kSpenceUncertainty;
      oracle.contact_radius = oracle.stick_radius = oracle.normal.approach = oracle.normal.peak_pressure = NAN;
      oracle.normal.reference_pressure = oracle.friction.moment_limit = NAN;
    }
    return {oracle, ""};
  };
}

ExactTheory pressed_ellipse(const solver::Scene& scene) {
  const Moduli pair = moduli(scene);
  const double friction = scene.contact.friction.coefficient;
  return [=, surface = scene.surfaces.front()](const solver::Step& step) -> OracleAnswer {
    constexpr std::array unknown_pair{double{NAN}, double{NAN}};
    Oracle oracle = pressed_ellipse_under(*step.normal, surface, pair, friction);
    const double limit = oracle.friction.moment_limit;
    const double a = oracle.contact_radius;
    oracle.moment = moment_of(step.torsion, limit);
    oracle.twist_angle = solver::value_if<solver::Twist>(step.torsion).value_or(NAN);
    oracle.force = step.displacement ? unknown_pair : step.force;
    oracle.displacement = step.displacement.value_or(unknown_pair);
    oracle.stick_radius = oracle.dissipated = NAN;
    oracle.state = {.moment_ratio = oracle.moment / limit,
                    .moment_deficit = 1.0 - std::abs(oracle.moment) / limit,
                    .stick_ratio = NAN,
                    .stick_complement = NAN,
                    .twist = oracle.twist_angle * pair.shear * a * a / oracle.friction.force,
                    .moment = oracle.moment / (oracle.friction.force * a),
                    .tangent_stiffness = NAN};
    oracle.only_normal =
        "normal contact only: no exact solution with friction is known here for shape = \"ellipsoid\" with "
        "two different radii";
    return {oracle, ""};
  };
}

ExactTheory no_theory(const std::string& reason) {
  return [reason](const solver::Step&) { return OracleAnswer{std::nullopt, reason}; };
}

}  // namespace slipstick::convergence
