#include "solver/newton/convex_program.hpp"

namespace slipstick::solver {

using Eigen::ArrayXd;

double ConvexProgram::energy(Index first, Index last, const ArrayXd& q, const ArrayXd& u) const {
  const Index n = last - first;
  double sum = 0.5 * (q.segment(first, n) * u.segment(first, n)).sum();
  if (g != nullptr) sum += (q.segment(first, n) * g->segment(first, n)).sum();
  for (const auto& [c, multiplier] : given) {
    sum -= multiplier * c->dot(first, q.segment(first, n));
  }
  return sum;
}

void ConvexProgram::descend(Index first, Index last, const ArrayXd& q, const ArrayXd& u, double length,
                            ArrayXd& y) const {
  const Index n = last - first;
  auto part = y.segment(first, n);
  part = q.segment(first, n) - length * u.segment(first, n);
  if (g != nullptr) part -= length * g->segment(first, n);
  for (const auto& [c, multiplier] : given) c->add_to(part, first, length * multiplier);
}

void ConvexProgram::write_slip(Index first, Index last, const ArrayXd& u, const Coefficients& multipliers,
                               ArrayXd& s) const {
  const Index n = last - first;
  auto part = s.segment(first, n);
  part = u.segment(first, n);
  if (g != nullptr) part += g->segment(first, n);
  for (const auto& [c, multiplier] : given) c->add_to(part, first, -multiplier);
  for (std::size_t k = 0; k < imposed.size(); ++k) {
    imposed[k].c->add_to(part, first, -multipliers[static_cast<Index>(k)]);
  }
}

}  // namespace slipstick::solver
