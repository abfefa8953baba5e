#include "solver/newton/convex_program.hpp"

namespace slipstick::solver {

using Eigen::ArrayXd;

double ConvexProgram::energy(const ArrayXd& q, const ArrayXd& u) const {
  double sum = 0.5 * (q * u).sum();
  if (g != nullptr) sum += (q * *g).sum();
  for (const auto& [c, multiplier] : given) sum -= multiplier * (q * *c).sum();
  return sum;
}

void ConvexProgram::descend(const ArrayXd& q, const ArrayXd& u, double length, ArrayXd& y) const {
  y = q - length * u;
  if (g != nullptr) y -= length * *g;
  for (const auto& [c, multiplier] : given) y += (length * multiplier) * *c;
}

void ConvexProgram::write_slip(const ArrayXd& u, const Coefficients& multipliers, ArrayXd& s) const {
  s = u;
  if (g != nullptr) s += *g;
  for (const auto& [c, multiplier] : given) s -= multiplier * *c;
  for (std::size_t k = 0; k < imposed.size(); ++k)
    s -= multipliers[static_cast<Eigen::Index>(k)] * *imposed[k].c;
}

}  // namespace slipstick::solver
