#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "convergence/results/solve_record.hpp"
#include "convergence/runs/solve_scene.hpp"

namespace slipstick::convergence {

/// The gaps of the continuous problem, and the interval of the number that the loads leave open, by three
/// further solves; missing numbers have the reason.
///
/// The least energy J*(M) of a moment is convex, and the twist is its derivative. With
/// J(q) - G <= J*(M) <= J(q) for tractions q that carry M, differences to the moments M + d and M - d bound
/// it: (J_low(M) - J_up(M - d))/d <= phi(M) <= (J_up(M + d) - J_low(M))/d. For a force, an imposed twist or
/// an imposed displacement another potential takes the place of J.
/// density: gets the density of the gap.
ContinuumRecord continuum_record(const solver::Scene& scene, const solver::Solution& solution,
                                 Eigen::ArrayXd* density = nullptr);

/// Solves with more cells until that interval is narrow enough.
struct ProvenAnswer {
  solver::Scene scene;  ///< with the last cells
  SolvedScene solved;   ///< with its continuum record
  Json account;         ///< the width, the attempts, and not_reached: why the interval is wider
  std::string text;     ///< the account for a person
};

/// width: of the interval, over the number. Throws InputError as solve() where already the scene's own cells
/// cannot be solved.
ProvenAnswer solve_until_proven(solver::Scene scene, double width,
                                const std::function<SolvedScene(const solver::Scene&)>& solve);

}  // namespace slipstick::convergence
