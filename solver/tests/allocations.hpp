#pragma once

namespace slipstick::solver {

/// Allocations of this program so far: by operator new; by malloc, which Eigen calls; and by FFTW's functions
/// that allocate. The linker's --wrap counts them, see CMakeLists.txt.
long allocations();

}  // namespace slipstick::solver
