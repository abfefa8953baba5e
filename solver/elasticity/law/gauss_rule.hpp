#pragma once

#include <vector>

namespace slipstick::solver {

/// Gauss-Legendre quadrature of so many points over an interval of length 1 about 0.
struct GaussRule {
  std::vector<double> node;
  std::vector<double> weight;
};
GaussRule make_gauss_rule(int points);

}  // namespace slipstick::solver
