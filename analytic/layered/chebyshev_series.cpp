#include "analytic/layered/chebyshev_series.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace slipstick::analytic::layered {

/// Angles from pi: the smallest argument comes first, at `low`.
double ChebyshevSeries::angle(std::size_t j, std::size_t terms) {
  return std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(terms);
}

void ChebyshevSeries::interpolate(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<double> cosines(4 * n);  // of multiples of pi/(2 n)
  for (std::size_t j = 0; j < 4 * n; ++j)
    cosines[j] = std::cos(std::numbers::pi * static_cast<double>(j) / (2 * static_cast<double>(n)));
  coefficients_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += values[j] * cosines[k * (2 * j + 1) % (4 * n)];
    const double sign = k % 2 == 0 ? 1 : -1;  // T_k(-x)
    coefficients_[k] = sign * sum * (k == 0 ? 1 : 2) / static_cast<double>(n);
  }
}

/// Clenshaw's recurrence.
double ChebyshevSeries::operator()(double x) const {
  const double y = 2 * ((x - low_) - (high_ - x)) / (high_ - low_);
  double next = 0;
  double sum = 0;
  for (std::size_t k = coefficients_.size(); k-- > 1;) {
    const double before = coefficients_[k] + y * sum - next;
    next = sum;
    sum = before;
  }
  return coefficients_[0] + y / 2 * sum - next;
}

ChebyshevSeries ChebyshevSeries::derivative() const {
  ChebyshevSeries result = *this;
  const std::size_t n = coefficients_.size();
  std::vector<double> slopes(n + 1, 0.0);
  for (std::size_t k = n - 1; k > 0; --k)
    slopes[k - 1] = (k + 1 <= n ? slopes[k + 1] : 0) + 2 * static_cast<double>(k) * coefficients_[k];
  slopes[0] /= 2;
  for (std::size_t k = 0; k < n; ++k) result.coefficients_[k] = slopes[k] * 2 / (high_ - low_);
  return result;
}

const ChebyshevSeries& ChebyshevPanels::at(double x) const {
  const auto above = std::upper_bound(panels_.begin(), std::prev(panels_.end()), x,
                                      [](double value, const auto& panel) { return value < panel.high(); });
  return *above;
}

ChebyshevPanels ChebyshevPanels::derivative() const {
  ChebyshevPanels result = *this;
  for (ChebyshevSeries& panel : result.panels_) panel = panel.derivative();
  return result;
}

std::vector<double> squared_ends(double radius, double detail) {
  const double panels = std::ceil(radius / (2 * detail));
  std::vector<double> ends{0};
  for (double i = 1; i <= panels; ++i) ends.push_back(radius * radius * (i / panels) * (i / panels));
  return ends;
}

}  // namespace slipstick::analytic::layered
