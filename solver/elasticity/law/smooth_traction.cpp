#include "solver/elasticity/law/smooth_traction.hpp"

#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace slipstick::solver {
namespace {

/// A cell's mean of a field is the value at its centre and this part of the second differences.
constexpr double kSecondDifference = 1.0 / 24.0;

}  // namespace

std::vector<double> smooth_table(const std::vector<double>& constant, Parity sign, Index m1, Index m2) {
  const auto at = [&](Index k1, Index k2) {
    const int factor = (k1 < 0 ? sign.x1 : 1) * (k2 < 0 ? sign.x2 : 1);
    return factor * constant[static_cast<std::size_t>(std::abs(k1) * (m2 + 1) + std::abs(k2))];
  };
  std::vector<double> smooth;
  smooth.reserve(static_cast<std::size_t>(m1 * m2));
  for (Index k1 = 0; k1 < m1; ++k1) {
    for (Index k2 = 0; k2 < m2; ++k2) {
      const double around = at(k1 + 1, k2) + at(k1 - 1, k2) + at(k1, k2 + 1) + at(k1, k2 - 1);
      smooth.push_back(at(k1, k2) - kSecondDifference * (around - 4.0 * at(k1, k2)));
    }
  }
  return smooth;
}

double sharpening(CellTraction cell_traction, double phase1, double phase2) {
  if (cell_traction == CellTraction::constant) return 1.0;
  const double s1 = std::sin(0.5 * phase1);
  const double s2 = std::sin(0.5 * phase2);
  return 1.0 + (s1 * s1 + s2 * s2) / 6.0;
}

}  // namespace slipstick::solver
