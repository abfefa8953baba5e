#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "analytic/cycle.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/stresses/largest_stress.hpp"
#include "analytic/stresses/stress_field.hpp"
#include "analytic/torsion.hpp"
#include "interfaces/c/boundary.hpp"

namespace slipstick::c {
namespace {

using analytic::Profile;
using analytic::TorsionState;

/// Relative: smaller errors are below rounding.
constexpr double kLeastLossError = 1e-14;

using StateAt = TorsionState (*)(double, const Profile&);
/// Numbers of enum slipstick_quantity: quantities that can be given, and members of a state.
constexpr std::array<StateAt, 5> kStateAt{analytic::from_moment_ratio, analytic::from_moment_deficit,
                                          analytic::from_stick_ratio, analytic::from_stick_complement,
                                          analytic::from_twist};
constexpr std::array kMembers{
    &TorsionState::moment_ratio,     &TorsionState::moment_deficit, &TorsionState::stick_ratio,
    &TorsionState::stick_complement, &TorsionState::twist,          &TorsionState::moment,
    &TorsionState::tangent_stiffness};

/// The entry of this number; the message allows numbers up to `last`.
template <class Table>
auto numbered(const Table& table, const char* name, int number, std::size_t last) {
  if (!(number >= 0 && number < static_cast<int>(table.size())))
    throw std::invalid_argument(fmt::format("{} = {}; allowed: 0 to {}", name, number, last));
  return table[static_cast<std::size_t>(number)];
}

StateAt state_by(int given) { return numbered(kStateAt, "given", given, kStateAt.size() - 1); }

/// An array from C; it may be null if it has no elements.
template <class Value>
std::span<Value> array(Value* values, std::size_t count, const char* name) {
  if (count > 0) require(values, name);
  return {values, count};
}

/// results[i] = function(values[i]); an error names the index of the value.
template <class Result, class Function>
void for_each(std::size_t n, const double* values, const char* name, Result* results, const char* results_name,
              const Function& function) {
  const auto from = array(values, n, name);
  const auto to = array(results, n, results_name);
  std::size_t i = 0;
  try {
    for (; i < n; ++i) to[i] = function(from[i]);
  } catch (const std::logic_error& error) {
    throw std::domain_error(fmt::format("{}[{}]: {}", name, i, error.what()));
  }
}

slipstick_state in_c(const TorsionState& state) {
  return {state.moment_ratio, state.moment_deficit, state.stick_ratio,      state.stick_complement,
          state.twist,        state.moment,         state.tangent_stiffness};
}

slipstick_cycle_state in_c(const analytic::CycleState& state) {
  return {state.moment_ratio, state.moment, state.twist, state.stick_ratio, state.tangent_stiffness, state.dissipated};
}

/// front: the radius at which slip ends.
struct StressedBody {
  analytic::StressField field;
  double front;
};

StressedBody stressed_body(const Profile& profile, int given, std::span<const double> values, double friction) {
  if (!(friction >= 0 && std::isfinite(friction)))
    throw std::domain_error(fmt::format("friction = {}; allowed: 0 or more, finite", friction));
  if (values.size() != 1 && given != SLIPSTICK_MOMENT_RATIO)
    throw std::invalid_argument(fmt::format("{} values; allowed: 1, or a history of moment ratios", values.size()));
  if (values.size() == 1 && values[0] >= 0) {
    const TorsionState state = state_by(given)(values[0], profile);
    return {{state, profile}, state.stick_ratio};
  }
  analytic::LoadingHistory history(profile);
  for (const double moment_ratio : values) history.load_to(moment_ratio);
  return {{history, profile}, history.state().stick_ratio};
}

slipstick_stress stress_at(const analytic::StressField& field, analytic::BodyPoint at, double friction,
                           double poisson) {
  const analytic::PressureStress normal = field.by_pressure(at, poisson);
  const analytic::TorsionStress shear = field.by_torsion(at);
  const analytic::Severity both = analytic::severity(normal, shear, friction);
  return {normal.rr, normal.tt, normal.zz, normal.rz, shear.rt, shear.tz, both.von_mises, both.tresca, both.tension};
}

/// Calls the work with the profile of this name. The profile of the last call is kept, since many calls in a
/// row name the same one; a file is read again, since it may have changed.
template <class Work>
int with_profile(const char* name, const Work& work) noexcept {
  return guarded([&] {
    require(name, "profile");
    thread_local std::string last_name;
    thread_local analytic::NamedProfile last;
    if (!last.profile || last_name != name || last.table) {
      last = analytic::find_profile(name);
      last_name = name;
    }
    work(*last.profile);
  });
}

}  // namespace
}  // namespace slipstick::c

using namespace slipstick;

int slipstick_exact(const char* profile, int given, size_t n, const double* values, int wanted, double* results) {
  if (wanted == SLIPSTICK_ENERGY_LOST)
    return slipstick_exact_energy_lost(profile, given, n, values, c::kLeastLossError, results);
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    const c::StateAt state_at = c::state_by(given);
    const auto member = c::numbered(c::kMembers, "wanted", wanted, SLIPSTICK_ENERGY_LOST);
    c::for_each(n, values, "values", results, "results", [&](double value) { return state_at(value, shape).*member; });
  });
}

int slipstick_exact_states(const char* profile, int given, size_t n, const double* values, slipstick_state* states) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    const c::StateAt state_at = c::state_by(given);
    c::for_each(n, values, "values", states, "states", [&](double value) { return c::in_c(state_at(value, shape)); });
  });
}

int slipstick_exact_energy_lost(const char* profile, int given, size_t n, const double* values, double relative_error,
                                double* results) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    const c::StateAt state_at = c::state_by(given);
    if (!(relative_error >= c::kLeastLossError && relative_error < 1.0)) {
      throw std::invalid_argument(
          fmt::format("relative_error = {}; allowed: {} to below 1", relative_error, c::kLeastLossError));
    }
    c::for_each(n, values, "values", results, "results", [&](double value) {
      return analytic::energy_lost_per_cycle(state_at(value, shape), shape, relative_error);
    });
  });
}

int slipstick_exact_traction(const char* profile, int given, double value, size_t n, const double* radii,
                             double* results) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    const analytic::TorsionState state = c::state_by(given)(value, shape);
    c::for_each(n, radii, "radii", results, "results",
                [&](double radius) { return analytic::traction(state, radius, shape); });
  });
}

int slipstick_exact_pressure(const char* profile, size_t n, const double* radii, double* results) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    c::for_each(n, radii, "radii", results, "results", [&](double r) {
      if (!(r >= 0 && r <= 1)) throw std::domain_error(fmt::format("r/a = {}; allowed: 0 <= r/a <= 1", r));
      return shape.pressure(r);
    });
  });
}

int slipstick_exact_profile(const char* profile, slipstick_profile* result) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    c::require(result, "result");
    *result = {shape.load(), shape.moment_limit(), shape.full_stick()};
  });
}

int slipstick_exact_history(const char* profile, size_t n, const double* moment_ratios, slipstick_cycle_state* states) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    analytic::LoadingHistory history(shape);
    c::for_each(n, moment_ratios, "moment_ratios", states, "states", [&](double moment_ratio) {
      history.load_to(moment_ratio);
      return c::in_c(history.state());
    });
  });
}

int slipstick_exact_curve(const char* profile, size_t n, const double* turning_points, size_t points_per_branch,
                          slipstick_cycle_state* states) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    c::require(states, "states");
    if (points_per_branch > static_cast<size_t>(std::numeric_limits<int>::max()))
      throw std::invalid_argument("points_per_branch is no number of points; allowed: 1 or more");
    const auto turning = c::array(turning_points, n, "turning_points");
    const std::vector<analytic::CycleState> curve =
        analytic::loading_curve({turning.begin(), turning.end()}, static_cast<int>(points_per_branch), shape);
    for (size_t i = 0; i < curve.size(); ++i) states[i] = c::in_c(curve[i]);
  });
}

int slipstick_exact_history_traction(const char* profile, size_t n_moments, const double* moment_ratios, size_t n_radii,
                                     const double* radii, double* results) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    analytic::LoadingHistory history(shape);
    for (const double moment_ratio : c::array(moment_ratios, n_moments, "moment_ratios")) history.load_to(moment_ratio);
    c::for_each(n_radii, radii, "radii", results, "results", [&](double radius) { return history.traction(radius); });
  });
}

int slipstick_exact_stresses(const char* profile, int given, size_t n_values, const double* values, double friction,
                             double poisson, size_t n, const double* radii, const double* depths,
                             slipstick_stress* results) {
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    const analytic::StressField field =
        c::stressed_body(shape, given, c::array(values, n_values, "values"), friction).field;
    const double* depth = c::array(depths, n, "depths").data();
    c::for_each(n, radii, "radii", results, "results", [&](double radius) {
      return c::stress_at(field, {radius, *depth++}, friction, poisson);
    });
  });
}

int slipstick_exact_largest_stress(const char* profile, int given, size_t n_values, const double* values,
                                   double friction, double poisson, int measure, slipstick_largest_stress* result) {
  using analytic::Severity;
  constexpr std::array kMeasures{&Severity::von_mises, &Severity::tresca, &Severity::tension};
  return c::with_profile(profile, [&](const analytic::Profile& shape) {
    c::require(result, "result");
    const auto wanted = c::numbered(kMeasures, "measure", measure, kMeasures.size() - 1);
    const auto body = c::stressed_body(shape, given, c::array(values, n_values, "values"), friction);
    const auto [value, at] = analytic::largest_stress(body.field, wanted, friction, poisson, body.front);
    *result = {value, at.radius, at.depth};
  });
}

int slipstick_exact_indentation(const char* profile, double load, double effective_modulus, size_t n_shape,
                                const double* shape, slipstick_indentation* result) {
  return c::guarded([&] {
    c::require(profile, "profile");
    c::require(result, "result");
    const auto lengths = c::array(shape, n_shape, "shape");
    const analytic::Indentation found =
        analytic::press(
            profile, {.load = load, .effective_modulus = effective_modulus, .shape = {lengths.begin(), lengths.end()}})
            .indentation;
    *result = {found.contact_radius, found.approach, found.reference_pressure};
  });
}
