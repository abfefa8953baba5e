#pragma once

namespace slipstick::solver {

/// How the operator is evaluated: by discrete convolution and FFT (N^2 log N work for N x N cells), by direct
/// summation without a matrix (N^4 work, N^2 memory), or by a dense matrix (N^4 of both).
enum class OperatorKind { dcfft, direct, dense };

/// The tractions that the cells' values represent: constant over each cell; or smooth, each value the
/// traction at its cell's centre. Displacements at the centres then have an error of third order in the cell
/// size instead of second, wherever the tractions are smooth.
enum class CellTraction { constant, smooth };

}  // namespace slipstick::solver
