#pragma once

namespace slipstick::solver {

/// How the operator is evaluated: by discrete convolution and FFT (N^2 log N work for N x N cells), by direct
/// summation without a matrix (N^4 work, N^2 memory), or by a dense matrix (N^4 of both).
enum class OperatorKind { dcfft, direct, dense };

/// Precision of the inner iterations; residuals and certificates are always double.
enum class Precision { double_precision, mixed };

}  // namespace slipstick::solver
