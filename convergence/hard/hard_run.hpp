#pragma once

#include <string>
#include <vector>

#include "convergence/hard/hard_case.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {

struct HardOptions {
  bool variants = true;  ///< each scene also seen otherwise, and on a mesh of twice the cells
  /// Gets a file of fields for each case that is solved; empty: none.
  std::filesystem::path fields = {};
};

/// Solves and judges. Rows in the order of the cases: family, case, set, verdict, reason, error, uncertainty,
/// applications, seconds, variants; counts by family and verdict. An answer is wrong too where one seen
/// otherwise differs from it, or where the mesh of twice the cells gives another one than its uncertainty
/// allows.
Json run_hard_cases(const std::vector<HardCase>& cases, const HardOptions& options, const ProcessPool& pool);

/// For a person: counts of each family, then what is wrong or did not converge, with the command that
/// repeats it.
std::string hard_text(const Json& result);

}  // namespace slipstick::convergence
