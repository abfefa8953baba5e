#pragma once

#include "convergence/exchange/solver_program.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/results/solve_record.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

/// Scenes that another program solves.
namespace slipstick::convergence {

/// The answer of a scene's program.
struct ProgramAnswer {
  solver::Scene scene;        ///< under the loads that the program was given, in N and N m
  OracleAnswer exact;         ///< at the same part of its limit moment, where a load is a ratio
  solver::Solution solution;  ///< from its fields only
  ProgramRecord program;
};

/// Solves a scene by its program:
///
///  1. pose() computes the scene's numbers, write_exchange() writes them.
///  2. run_solver_program() runs the program, read_exchange() reads its field.
///  3. describe_given() makes a solution of the field; loads that are off by more than a twentieth, or the
///     program's own word, make it not converged.
///
/// A load that is a ratio becomes a moment by the limit of the grid's own pressure, as for the built-in methods. Throws
/// ProgramFailure where the program fails; InputError for a scene that it does not solve, and a history.
ProgramAnswer solve_by_program(const solver::Scene& scene, const AllowedPrograms& allowed);

}  // namespace slipstick::convergence
