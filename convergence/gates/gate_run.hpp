#pragma once

#include <vector>

#include "convergence/gates/gate.hpp"
#include "convergence/runs/process_pool.hpp"

/// The solves, studies and files by which gates are judged.
namespace slipstick::convergence {

/// 1. Solves all scenes in parallel and equal ones once, runs the studies, reads the files; 2. judges the gates;
/// 3. finds the largest part of the error where a gate on an error fails. A gate whose source cannot be read
/// is refused, and the others are judged. A pool that lists runs gets the runs of 1, and once they have
/// results the runs of 3.
std::vector<Judgement> run_gates(const std::vector<Gate>& gates, const ProcessPool& pool);

/// The sources of the gates in their order, then those of the numbers to which gates are relative; each once.
std::vector<GateSource> sources_of(const std::vector<Gate>& gates);

}  // namespace slipstick::convergence
