#include "convergence/laws/twist_law.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace slipstick::convergence {
namespace {

constexpr std::size_t kMaxPieces = 200;
/// Nodes of the interpolation that a piece is cut out of.
constexpr std::size_t kNodes = 24;
/// Points at which a piece is compared with the function.
constexpr int kCompared = 40;

/// Interpolates at Chebyshev's points, the roots of the polynomial of degree kNodes.
std::vector<double> interpolate(const std::function<double(double)>& f, double low, double high) {
  std::vector<double> values(kNodes);
  const auto angle = [](std::size_t node) {
    return std::numbers::pi * (static_cast<double>(node) + 0.5) / static_cast<double>(kNodes);
  };
  for (std::size_t node = 0; node < kNodes; ++node) {
    values[node] = f(std::midpoint(low, high) + 0.5 * (high - low) * std::cos(angle(node)));
  }
  std::vector<double> coefficients(kNodes);
  for (std::size_t k = 0; k < kNodes; ++k) {
    double sum = 0.0;
    for (std::size_t node = 0; node < kNodes; ++node) {
      sum += values[node] * std::cos(static_cast<double>(k) * angle(node));
    }
    coefficients[k] = sum * (k == 0 ? 1.0 : 2.0) / static_cast<double>(kNodes);
  }
  return coefficients;
}

/// Leaves out the last coefficients as long as they sum up to less than `allowed`.
void cut(std::vector<double>& coefficients, double allowed) {
  double left_out = 0.0;
  while (coefficients.size() > 1) {
    left_out += std::abs(coefficients.back());
    if (!(left_out <= allowed)) break;
    coefficients.pop_back();
  }
}

/// The largest relative error; infinite where f is not a number.
double error_found(const ChebyshevPiece& piece, const std::function<double(double)>& f) {
  double largest = 0.0;
  for (int i = 0; i < kCompared; ++i) {
    const double x = piece.low + (piece.high - piece.low) * (i + 0.5) / kCompared;
    const double value = f(x);
    const double error = std::abs(piece(x) / value - 1.0);
    largest = std::isfinite(error) ? std::max(largest, error) : INFINITY;
  }
  return largest;
}

}  // namespace

double ChebyshevPiece::operator()(double x) const {
  const double scaled = (2.0 * x - low - high) / (high - low);
  double next = 0.0;
  double after = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 1;) {
    const double value = coefficients[k] + 2.0 * scaled * next - after;
    after = next;
    next = value;
  }
  return coefficients[0] + scaled * next - after;
}

double PiecewiseChebyshev::operator()(double x) const {
  const auto after = std::find_if(pieces.begin(), pieces.end() - 1,
                                  [&](const ChebyshevPiece& piece) { return x <= piece.high; });
  return (*after)(x);
}

std::size_t PiecewiseChebyshev::degree() const {
  std::size_t degree = 0;
  for (const ChebyshevPiece& piece : pieces) degree = std::max(degree, piece.coefficients.size() - 1);
  return degree;
}

PiecewiseChebyshev fit_chebyshev(const std::function<double(double)>& f, const std::vector<double>& knots,
                                 double tolerance) {
  PiecewiseChebyshev fit;
  std::vector<std::pair<double, double>> left;  // the last is the leftmost
  for (std::size_t k = knots.size(); k-- > 1;) left.emplace_back(knots[k - 1], knots[k]);
  while (!left.empty()) {
    const auto [low, high] = left.back();
    left.pop_back();
    ChebyshevPiece piece{low, high, interpolate(f, low, high)};
    const double least = std::min(std::abs(f(low + 1e-9 * (high - low))), std::abs(f(high)));
    cut(piece.coefficients, 0.25 * tolerance * least);
    const bool small = piece.coefficients.size() <= kMaxDegree + 1;
    const double error = small ? error_found(piece, f) : INFINITY;
    if (error <= 0.5 * tolerance) {
      fit.error = std::max(fit.error, error);
      fit.pieces.push_back(std::move(piece));
      continue;
    }
    const double middle = std::midpoint(low, high);
    if (fit.pieces.size() + left.size() >= kMaxPieces || !(low < middle && middle < high)) {
      throw std::domain_error(
          fmt::format("{} pieces do not reach an error of {}; allowed: a larger one", kMaxPieces, tolerance));
    }
    left.emplace_back(middle, high);
    left.emplace_back(low, middle);
  }
  return fit;
}

}  // namespace slipstick::convergence
