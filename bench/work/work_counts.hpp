#pragma once

namespace slipstick::bench {

/// Work that a program has done so far, counted one by one. The same on every machine, up to the iterations
/// that rounding takes more or less: what libraries do inside is not counted.
struct WorkCounts {
  long plans = 0;               ///< made by FFTW
  long transforms = 0;          ///< calls of FFTW's functions that execute a plan
  long transformed_points = 0;  ///< lengths of all lines, or areas of all planes, that those transform
  long allocations = 0;         ///< by operator new, by malloc and its like, by FFTW's functions that allocate
  long allocated_bytes = 0;     ///< requested bytes, including memory that was freed again
  long kernel_evaluations = 0;  ///< cells over which Boussinesq's and Cerruti's solutions were integrated
};

/// Counts of this program so far; for one thread only. The linker's --wrap replaces the counted functions by
/// counting ones in the program, not in shared libraries; see CMakeLists.txt.
WorkCounts work_counts();

/// The work between two counts.
WorkCounts operator-(const WorkCounts& after, const WorkCounts& before);

}  // namespace slipstick::bench
