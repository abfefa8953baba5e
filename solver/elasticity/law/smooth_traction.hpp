#pragma once

#include <vector>

#include "solver/elasticity/operator_kind.hpp"
#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// The m1 x m2 table of smooth cell tractions, from one of constant ones that has one row and one column
/// more. sign: the parity of its component.
std::vector<double> smooth_table(const std::vector<double>& constant, Parity sign, Index m1, Index m2);

/// The factor of a symbol by second differences: 1 less the sum of theirs over 24. phase: xi h, of a wave
/// from a cell to the next.
double sharpening(CellTraction cell_traction, double phase1, double phase2);

}  // namespace slipstick::solver
