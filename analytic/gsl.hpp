#pragma once

#include <gsl/gsl_mode.h>
#include <gsl/gsl_sf_result.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace slipstick::analytic {
/// A real function of one real variable.
using RealFunction = std::function<double(double)>;
}  // namespace slipstick::analytic

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
double root(const RealFunction& f, double low, double high);

/// The integral of f over [low, high] by doubly adaptive quadrature, to a relative error, or as accurately as
/// the rounding of f allows.
double integral(const RealFunction& f, double low, double high, double relative = 1e-14);

/// Gauss's rule, exact for degree 2 points - 1.
class GaussRule {
 public:
  /// A point of [0, 1].
  struct Node {
    double fraction;
    double weight;
  };

  /// Up to 20 points (or 32, 64) GSL has to all digits; others it makes itself, to fewer.
  explicit GaussRule(std::size_t points);

  const std::vector<Node>& nodes() const { return nodes_; }

  template <class Function>
  double operator()(const Function& f, double low, double high) const {
    double sum = 0;
    for (const auto& [fraction, weight] : nodes_) sum += weight * f(low + (high - low) * fraction);
    return (high - low) * sum;
  }

 private:
  std::vector<Node> nodes_;
};

/// The integral over a panel beyond which f is analytic well enough for 20 points to give all digits.
template <class Function>
double gauss_legendre(const Function& f, double low, double high) {
  static const GaussRule rule(20);
  return rule(f, low, high);
}

/// Slopes at the knots of Steffen's interpolation (1990): piecewise cubic, monotone between any two knots.
/// x must increase; at least three points.
std::vector<double> steffen_slopes(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace slipstick::analytic::gsl
