#pragma once

#include "convergence/exchange/given_fields.hpp"
#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/result_parts.hpp"

/// The files by which a scene goes to another program and its answer comes back;
/// docs/schema/exchange.schema.json.
namespace slipstick::convergence {

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

/// The program's own numbers, as far as it wrote any: twist, iterations, seconds, converged, message.
Json read_own_numbers(const SolverProgram& program, const ExchangeFiles& files);

}  // namespace slipstick::convergence
