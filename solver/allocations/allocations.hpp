#pragma once

/// Counts allocations, in tests and where work is counted; no part of the library. The linker's --wrap puts
/// counting functions in the place of those that allocate, in all of a program but not in shared libraries,
/// see CMakeLists.txt.
namespace slipstick::solver {

/// Allocations of this program so far: by operator new; by malloc, which Eigen calls, and its like; and by
/// FFTW's functions that allocate.
long allocations();

/// Bytes that those asked for, what was freed again among them.
long allocated_bytes();

}  // namespace slipstick::solver
