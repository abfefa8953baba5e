#pragma once

#include "solver/model/model.hpp"

namespace slipstick::solver {

/// Memory that solving the scene takes, in bytes, at most: operators, workspaces, fields.
struct Memory {
  double solver;  ///< operators and workspaces of the larger of the two problems
  double fields;  ///< the model's and the solution's, and the program itself
  double total() const { return solver + fields; }
};
/// Fractions of the cells that are candidates for contact and for friction in Newton's method. They are known
/// once the coarser grids are solved.
struct CandidateFraction {
  double pressure = 1.0;
  double tractions = 1.0;
};
Memory predicted_memory(const Scene& scene, const Model& model, const CandidateFraction& parts = {});
/// Throws OutOfMemory where that does not fit.
void require_memory(const Scene& scene, const Model& model, const CandidateFraction& parts);
/// The same of any number of bytes.
void require_memory(const Scene& scene, const Grid& grid, double bytes);

/// Memory while stresses below the surface are computed after a solve, with the given number of states of a
/// cycle, in bytes, at most.
double memory_of_stresses(const Grid& grid, std::size_t states);

/// The same for the tables that the scene names: each is held as a whole while it is read.
void require_memory_for_files(const Scene& scene);
/// The same for the fields that a grid needs before and after the solve.
void require_memory_around(const Scene& scene, const Grid& grid);

}  // namespace slipstick::solver
