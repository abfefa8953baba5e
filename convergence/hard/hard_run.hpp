#pragma once

#include <string>
#include <vector>

#include "convergence/hard/hard_case.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {

struct HardOptions {
  bool variants = true;      ///< each scene is seen otherwise too
  bool finer_meshes = true;  ///< those without an exact answer are solved on finer meshes too
  /// Words of solver.method that solve each scene too, to be compared with the first answer.
  std::vector<std::string> methods = {};
  /// Gets a file of fields for each case that is solved; empty: none.
  std::filesystem::path fields = {};
};

/// Solves and judges. Rows in the order of the cases, counts by family and verdict:
/// docs/schema/hard.schema.json. An answer is wrong too where the same contact seen otherwise has another
/// one.
Json run_hard_cases(const std::vector<HardCase>& cases, const HardOptions& options, const ProcessPool& pool);

/// For a person: counts of each family, then what is wrong or did not converge, with the command that
/// repeats it.
std::string hard_text(const Json& result);

}  // namespace slipstick::convergence
