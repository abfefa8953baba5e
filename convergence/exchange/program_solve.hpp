#pragma once

#include "convergence/exchange/allowed_programs.hpp"
#include "convergence/exchange/given_fields.hpp"
#include "convergence/exchange/solver_program.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/results/solve_record.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

/// Scenes that another program solves.
namespace slipstick::convergence {

/// What a scene's program found.
struct ProgramAnswer {
  solver::Scene scene;        ///< under the loads that the program was given, in N and N m
  OracleAnswer exact;         ///< at the same part of its limit moment, where a load is a ratio
  solver::Solution solution;  ///< worked out from its fields alone
  ProgramRecord program;
};

/// Gives the scene to its program and works out the answer from the field that it writes. A load that is a
/// ratio is given as that of the limit moment of the grid's own pressure, as for this program's own methods.
/// Throws ProgramFailure where the program fails; InputError for a scene that it does not solve, and a
/// history.
ProgramAnswer solve_by_program(const solver::Scene& scene, const AllowedPrograms& allowed);

// ---------------------------------------------------------------- the files of an exchange,
// docs/schema/exchange.schema.json (exchange_files.cpp)

/// Writes the scene worked out: grid, cell centres, materials, loads, and beside it the gap and a given
/// pressure.
void write_exchange(const SolverProgram& program, const ExchangeFiles& files, const solver::Scene& scene,
                    const PosedScene& posed);

/// The fields that a program wrote; tractions are zero and `tractions` is false where it found the pressure
/// alone. Throws ProgramFailure for a file that is missing, broken, of another grid, that holds what is no
/// number or a negative pressure, or carries another normal load.
struct ReadFields {
  GivenFields fields;
  bool tractions;
};
ReadFields read_exchange(const SolverProgram& program, const ExchangeFiles& files, const solver::Scene& scene,
                         const PosedScene& posed);

/// The program's own numbers, as far as it wrote any: twist_angle (rad), iterations, seconds, converged,
/// message.
OwnNumbers read_own_numbers(const SolverProgram& program, const ExchangeFiles& files);

}  // namespace slipstick::convergence
