#pragma once

#include <string>
#include <vector>

#include "convergence/hard/hard_case.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {

/// What solves each scene too: a name, and the override of the scene's keys that asks for it.
struct BesideMethod {
  std::string name;
  std::string override;
  bool is_program = false;
};
/// A word of solver.method, or the file of a program (TOML). Throws InputError for what is neither.
BesideMethod read_beside_method(const std::string& word);

struct HardOptions {
  bool variants = true;                    ///< each scene is seen otherwise too
  bool finer_meshes = true;                ///< those without an exact answer are solved on finer meshes too
  std::vector<BesideMethod> methods = {};  ///< to be compared with the first answer
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
