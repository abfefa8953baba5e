#pragma once

#include <vector>

#include "convergence/gates/gate.hpp"
#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {

/// Computes what gates ask for, all scenes side by side and equal ones once, or reads it, and judges it. A
/// gate whose scene, study or result cannot be read is refused; the others are judged all the same.
std::vector<Judgement> run_gates(const std::vector<Gate>& gates, const ProcessPool& pool);

/// The gates, and after them those that others are relative to, as gates of their own, in the same order.
std::vector<Gate> with_others(const std::vector<Gate>& gates);

/// The runs whose results these gates are judged by; where one fails, the parts of its error take some more.
/// What cannot be read is left to run_gates().
std::vector<PreparedRun> gate_runs(const std::vector<Gate>& gates, const ProcessPool& pool);

}  // namespace slipstick::convergence
