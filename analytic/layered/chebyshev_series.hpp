#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace slipstick::analytic::layered {

/// A polynomial on [low, high], by its Chebyshev coefficients.
class ChebyshevSeries {
 public:
  /// Interpolates f at `terms` Chebyshev points, none of them an end.
  template <class Function>
  ChebyshevSeries(const Function& f, double low, double high, std::size_t terms) : low_(low), high_(high) {
    std::vector<double> values(terms);
    for (std::size_t j = 0; j < terms; ++j) {
      const double half = std::sin(angle(j, terms) / 2);  // all digits of the distance from `low`
      values[j] = f(low + (high - low) * half * half);
    }
    interpolate(values);
  }

  double operator()(double x) const;
  ChebyshevSeries derivative() const;
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  static double angle(std::size_t j, std::size_t terms);
  void interpolate(const std::vector<double>& values);

  double low_;
  double high_;
  std::vector<double> coefficients_;
};

/// Series on adjoining panels.
class ChebyshevPanels {
 public:
  /// ends: of the panels, rising.
  template <class Function>
  ChebyshevPanels(const Function& f, const std::vector<double>& ends, std::size_t terms) {
    for (std::size_t i = 1; i < ends.size(); ++i) panels_.emplace_back(f, ends[i - 1], ends[i], terms);
  }

  /// The panel that holds x; the first or last one for an x outside.
  const ChebyshevSeries& at(double x) const;
  double operator()(double x) const { return at(x)(x); }
  ChebyshevPanels derivative() const;
  const std::vector<ChebyshevSeries>& panels() const { return panels_; }

 private:
  std::vector<ChebyshevSeries> panels_;
};

/// Ends of panels of t^2, 0 <= t <= radius, on which 24 terms hold an even function of t that is analytic up
/// to 2 detail off the real axis: 4.2^-24 is 1e-15.
std::vector<double> squared_ends(double radius, double detail);
inline constexpr double kTerms = 24;

}  // namespace slipstick::analytic::layered
