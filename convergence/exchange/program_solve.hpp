#pragma once

#include <nlohmann/json.hpp>

#include "convergence/exchange/allowed_programs.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

/// Scenes that another program solves.
namespace slipstick::convergence {

/// What a scene's program found.
struct ProgramAnswer {
  solver::Scene scene;        ///< under the loads that the program was given, in N and N m
  OracleAnswer exact;         ///< at the same part of its limit moment, where a load is a ratio
  solver::Solution solution;  ///< worked out from its fields alone
  Json program;               ///< name, version, its own numbers, seconds
};

/// Gives the scene to its program and works out the answer from the field that it writes. A load that is a
/// ratio is given as that of the limit moment of the grid's own pressure, as for this program's own methods.
/// Throws ProgramFailure where the program fails; InputError for a scene that it does not solve, and a
/// history.
ProgramAnswer solve_by_program(const solver::Scene& scene, const AllowedPrograms& allowed);

}  // namespace slipstick::convergence
