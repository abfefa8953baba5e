#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// A kernel on a grid. diagonal: the diagonal is a mirror.
struct KernelCase {
  std::string name;
  Grid grid;
  BlockKernel kernel;
  bool diagonal = false;

  bool tangential() const { return kernel == tangential_kernel(); }
  Index size() const { return static_cast<Index>(kernel.inputs) * grid.cells(); }
};
inline void PrintTo(const KernelCase& tested, std::ostream* stream) { *stream << tested.name; }

/// All kernels that each grid has: a whole one also the coupling, a square quadrant also the mirror at the diagonal.
inline std::vector<KernelCase> kernel_cases(const std::vector<Grid>& grids) {
  std::vector<KernelCase> cases;
  for (const Grid& grid : grids) {
    const std::string quadrant = grid.quadrant ? "quadrant_" : "";
    const std::string shape = quadrant + std::to_string(grid.n1) + "x" + std::to_string(grid.n2);
    cases.push_back({"normal_" + shape, grid, normal_kernel()});
    cases.push_back({"tangential_" + shape, grid, tangential_kernel()});
    if (!grid.quadrant) cases.push_back({"coupling_" + shape, grid, coupling_kernel()});
    if (grid.quadrant && grid.n1 == grid.n2) cases.push_back({"diagonal_" + shape, grid, tangential_kernel(), true});
  }
  return cases;
}

inline std::vector<KernelCase> cases_without(std::vector<KernelCase> cases, bool (*left_out)(const KernelCase&)) {
  std::erase_if(cases, left_out);
  return cases;
}

}  // namespace slipstick::solver
