#pragma once

#include <gsl/gsl_mode.h>
#include <gsl/gsl_sf_result.h>

#include <functional>

/// GSL behind C++ calls: its abort handler off, every status checked, every handle freed.
namespace slipstick::analytic::gsl {

/// Makes GSL return statuses instead of aborting the program. Called by everything below.
void turn_abort_handler_off();

/// Throws std::domain_error on GSL_EDOM, std::runtime_error on any other failure, with GSL's reason.
void check(int status);

/// A special function of GSL (a `gsl_sf_..._e`) at full precision.
template <class Function, class... Arguments>
double evaluate(Function* function, Arguments... arguments) {
  turn_abort_handler_off();
  gsl_sf_result result;
  check(function(arguments..., GSL_PREC_DOUBLE, &result));
  return result.val;
}

/// The root of f in [low, high], to the last digits, by Brent's method. f must change sign there.
double root(const std::function<double(double)>& f, double low, double high);

/// The integral of f over [low, high] by doubly adaptive quadrature, as accurately as the rounding of f
/// allows.
double integral(const std::function<double(double)>& f, double low, double high);

/// Gauss's rule of 24 points over [low, high]: exact to the last digits where f is analytic well beyond.
double gauss_legendre(const std::function<double(double)>& f, double low, double high);

}  // namespace slipstick::analytic::gsl
