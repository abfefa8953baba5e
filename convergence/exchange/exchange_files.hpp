#pragma once

#include "convergence/exchange/given_fields.hpp"
#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/solve_record.hpp"
#include "solver/scene/scene.hpp"

/// The files of an exchange with another program, docs/schema/exchange.schema.json.
namespace slipstick::convergence {

/// Writes the scene's numbers: grid, cell centres, materials, loads; and the gap and a given pressure as
/// files of their own.
void write_exchange(const SolverProgram& program, const ExchangeFiles& files, const solver::Scene& scene,
                    const PosedScene& posed);

/// The fields that a program wrote; tractions are zero and `tractions` is false where it found only the
/// pressure. Throws ProgramFailure for a file that is missing, broken or of another grid, that holds no
/// finite number or a negative pressure, or that carries another normal load.
struct ReadFields {
  GivenFields fields;
  bool tractions;
};
ReadFields read_exchange(const SolverProgram& program, const ExchangeFiles& files, const solver::Scene& scene,
                         const PosedScene& posed);

/// The program's own numbers, if it wrote any: twist_angle (rad), iterations, seconds, converged, message.
OwnNumbers read_own_numbers(const SolverProgram& program, const ExchangeFiles& files);

}  // namespace slipstick::convergence
