#pragma once

namespace slipstick::solver {

/// How the operator is evaluated: by discrete convolution and FFT (N^2 log N work for N x N cells), by direct
/// summation without a matrix (N^4 work, N^2 memory), or by a dense matrix (N^4 of both).
enum class OperatorKind { dcfft, direct, dense };

/// Which tractions the numbers of the cells stand for: constant over each cell; or smooth, each the traction
/// at its cell's centre. Displacements at the centres are then right to the third order in a cell's size
/// instead of the second, wherever the tractions are smooth.
enum class CellTraction { constant, smooth };

}  // namespace slipstick::solver
