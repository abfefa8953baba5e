#include "convergence/results/profile.hpp"

#include <cmath>

#include "convergence/oracle/errors.hpp"

namespace slipstick::convergence {

Json profile_json(const solver::Solution& solution, const OracleAnswer& answer) {
  if (!answer.oracle || !answer.oracle->shear) return Json::array();
  const Oracle& oracle = *answer.oracle;
  const ExactFields exact = exact_fields(oracle, solution.grid);
  const double unit = 1.0 / (oracle.friction * oracle.reference_pressure);
  const Eigen::ArrayXd value = unit * solver::norms(solution.traction);
  const Eigen::ArrayXd exact_value = unit * solver::norms(exact.traction);
  const solver::Grid& grid = solution.grid;
  Json rows = Json::array();
  const auto add = [&](solver::Index i, solver::Index j) {
    const solver::Index cell = i * grid.n2 + j;
    const double radius = std::hypot(grid.x1(i), grid.x2(j)) / oracle.contact_radius;
    if (radius > 1.0) return;
    rows.push_back({{"radius", radius},
                    {"value", value[cell]},
                    {"exact", exact_value[cell]},
                    {"error", value[cell] - exact_value[cell]}});
  };
  for (solver::Index i = grid.n1 / 2; i < grid.n1; ++i) add(i, grid.n2 / 2);
  for (solver::Index i = grid.n1 / 2 + 1; i < grid.n1; ++i) add(i, i);
  return rows;
}

}  // namespace slipstick::convergence
