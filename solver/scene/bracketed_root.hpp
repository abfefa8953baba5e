#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <cmath>
#include <concepts>
#include <memory>
#include <stdexcept>

namespace slipstick::solver {

/// The root of f in [low, high], to the last digits, by Brent's method (GSL). f must change sign there, or be
/// zero at an end; throws std::domain_error otherwise.
template <std::invocable<double> Function>
double bracketed_root(const Function& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (at_low == 0.0) return low;
  if (at_high == 0.0) return high;
  if (!(std::signbit(at_low) != std::signbit(at_high) && std::isfinite(at_low) && std::isfinite(at_high))) {
    throw std::domain_error("a bracket in which the function does not change sign, or is not finite");
  }
  // GSL's own handler would end the program.
  [[maybe_unused]] static const auto handler = gsl_set_error_handler_off();
  gsl_function function;
  function.function = [](double x, void* data) { return (*static_cast<const Function*>(data))(x); };
  function.params = const_cast<Function*>(&f);
  const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  gsl_root_fsolver_set(solver.get(), &function, low, high);
  constexpr int kMaxIterations = 200;  // plain bisection would need about 60
  double root = gsl_root_fsolver_root(solver.get());
  for (int i = 0; i < kMaxIterations; ++i) {
    if (gsl_root_fsolver_iterate(solver.get()) != GSL_SUCCESS) {
      throw std::domain_error("a function that is not finite everywhere in its bracket");
    }
    const double last = root;
    root = gsl_root_fsolver_root(solver.get());
    const double lower = gsl_root_fsolver_x_lower(solver.get());
    const double upper = gsl_root_fsolver_x_upper(solver.get());
    if (root == last || !(std::nextafter(lower, upper) < upper)) break;
  }
  return root;
}

}  // namespace slipstick::solver
