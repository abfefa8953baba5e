// The exact side: stick ratio from a moment, twist and one traction, over inputs that span the range. Each
// time is printed with the worst error over all proven references (error_eps, in units of 2.2e-16) and the
// allowed error: 8, or 4 times the change by an ulp of the input.

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "analytic/references/references.hpp"
#include "bench/suite/suite.hpp"

namespace slipstick::bench {
namespace {

constexpr std::size_t kInputs = 256;
using Inputs = std::array<double, kInputs>;

/// Half the inputs uniform in (0, 1), the other half logarithmic down to 1e-12, in an order that no branch
/// predictor learns.
Inputs spread() {
  Inputs inputs{};
  for (std::size_t i = 0; i < kInputs; ++i) {
    const double place = (static_cast<double>((i * 97) % kInputs) + 0.5) / kInputs;
    inputs[i] = i % 2 == 0 ? place : std::pow(10.0, -12 * place);
  }
  return inputs;
}

/// The worst ratio of error to allowed error of a quantity, over the certified table and the hardest inputs known.
Prepared judged(const std::string& profile, const std::string& given, const std::string& quantity) {
  analytic::testing::Replay worst{.error = 0, .allowed = analytic::testing::kAllowed};
  for (const auto& row : analytic::testing::all_references()) {
    if (row.text("profile") != profile || row.text("quantity") != quantity) continue;
    if (!given.empty() && row.text("given") != given) continue;
    const auto replay = analytic::testing::replay(row);
    if (!(replay.error / replay.allowed <= worst.error / worst.allowed)) worst = replay;
  }
  const bool right = worst.error > 0 && worst.error <= worst.allowed;
  return {.counters = {{"error_eps", worst.error}, {"allowed_eps", worst.allowed}},
          .invalid_reason = right ? "" : "disagrees with its references, or has none"};
}

/// Times f(i), i running over the inputs, one call an iteration.
template <class Function>
Prepared timed(Prepared prepared, Function f) {
  prepared.timing = repeated([f, i = std::size_t{0}]() mutable { benchmark::DoNotOptimize(f(i++ % kInputs)); });
  return prepared;
}

const analytic::Profile& profile(const std::string& name) { return *analytic::find_profile(name).profile; }

Prepared stick_ratio_from_moment(const std::string& name) {
  return timed(judged(name, "moment_ratio", "stick_ratio"),
               [moment_ratios = spread(), &at = profile(name)](std::size_t i) {
                 return analytic::from_moment_ratio(moment_ratios[i], at).stick_ratio;
               });
}

Prepared twist_from_stick_ratio(const std::string& name) {
  return timed(judged(name, "stick_ratio", "twist"), [ratios = spread(), &at = profile(name)](std::size_t i) {
    return at.twist_integral({.ratio = ratios[i], .complement = 1 - ratios[i]}) / (2 * at.load());
  });
}

Prepared state_from_stick_ratio(const std::string& name) {
  return timed(judged(name, "stick_ratio", "moment_deficit"), [ratios = spread(), &at = profile(name)](std::size_t i) {
    return analytic::from_stick_ratio(ratios[i], at).moment_deficit;
  });
}

Prepared one_traction(const std::string& name) {
  const Inputs fractions = spread();
  std::array<analytic::TorsionState, kInputs> states{};
  for (std::size_t i = 0; i < kInputs; ++i)
    states[i] = analytic::from_stick_ratio(fractions[(i + 31) % kInputs], profile(name));
  return timed(judged(name, "", "traction"), [fractions, states, &at = profile(name)](std::size_t i) {
    return analytic::traction(states[i], fractions[i] * states[i].stick_ratio, at);
  });
}

}  // namespace

void add_exact_benchmarks(Suite& suite) {
  const auto add = [&suite](const std::string& what, Prepared (*prepare)(const std::string&)) {
    for (const std::string profile : {"hertz", "cone", "flat_punch"}) {
      suite.add(fmt::format("exact/{}/{}", what, profile), [prepare, profile] { return prepare(profile); })
          ->Unit(benchmark::kNanosecond);
    }
  };
  add("stick_ratio_from_moment", stick_ratio_from_moment);
  add("twist_from_stick_ratio", twist_from_stick_ratio);
  add("state_from_stick_ratio", state_from_stick_ratio);
  add("traction", one_traction);
}

}  // namespace slipstick::bench
