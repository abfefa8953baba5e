#pragma once

/// Counts allocations, in tests and where work is counted; no part of the library. The linker's --wrap replaces
/// allocating functions by counting ones, in a program but not in shared libraries, see CMakeLists.txt.
namespace slipstick::solver {

/// Allocations of this program so far: by operator new, by malloc, calloc and realloc (Eigen), and by FFTW.
long allocations();

/// Bytes of these allocations, freed ones included.
long allocated_bytes();

}  // namespace slipstick::solver
