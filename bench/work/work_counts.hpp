#pragma once

namespace slipstick::bench {

/// Work that a program has done so far, counted one by one. The same on every machine, up to the iterations
/// that rounding takes more or less: what libraries do inside is not counted.
struct WorkCounts {
  long plans = 0;               ///< made by FFTW
  long transforms = 0;          ///< calls of FFTW's functions that execute a plan
  long transformed_points = 0;  ///< lengths of all lines, or areas of all planes, that those transform
  long allocations = 0;      ///< by operator new, by malloc and its like, by FFTW's functions that allocate
  long allocated_bytes = 0;  ///< as asked for, what was freed again among them
  long kernel_evaluations = 0;  ///< cells over which Boussinesq's and Cerruti's solutions were integrated
};

/// Counts of this program so far; of one that uses a single thread. The linker's --wrap puts counting
/// functions in the place of those that are counted, in all of the program but not in shared libraries, see
/// CMakeLists.txt.
WorkCounts work_counts();

/// The work between two counts.
WorkCounts operator-(const WorkCounts& after, const WorkCounts& before);

}  // namespace slipstick::bench
