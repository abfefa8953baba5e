// What somebody else's program looks like: solve a scene, compare its twist with the exact one.

#include <cmath>

#include "convergence/oracle/oracle.hpp"
#include "solver/solve.hpp"

int main(int, char** arguments) {
  const auto scene = slipstick::solver::read_scene(arguments[1], {"grid.cells=[32,32]"});
  const auto solution = slipstick::solver::solve(scene);
  const auto exact = slipstick::convergence::find_oracle(scene).oracle;
  return std::abs(solution.twist_angle / exact->twist_angle - 1.0) <= 1e-2 ? 0 : 1;
}
