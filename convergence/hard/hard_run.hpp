#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "convergence/hard/hard_case.hpp"
#include "convergence/runs/process_pool.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

struct HardOptions {
  bool variants = true;                    ///< also solve equivalent scenes, see Variant
  bool finer_meshes = true;                ///< also solve scenes without an exact answer on finer meshes
  std::vector<BesideMethod> methods = {};  ///< to be compared with the first answer
  /// Gets a file of fields for each case that is solved; empty: none.
  std::filesystem::path fields = {};
};

/// A case, its answer, and the other answers to it.
struct HardRow {
  HardCase hard;
  std::filesystem::path fields;  ///< of its answer; empty: none
  SolveRecord record;
  JudgedCase judged;
  std::optional<solver::Scene> scene;                           ///< of certified cases
  std::vector<std::pair<std::string, Number>> variants;         ///< variant_difference() by the variant's name
  std::vector<std::pair<std::string, ComparedAnswer>> methods;  ///< by the method's name
};

/// Rows in the order of the cases.
struct HardResult {
  std::vector<HardRow> rows;
  std::vector<std::string> methods;  ///< names

  /// Numbers of cases by HardVerdict, and of a method's answers by MethodVerdict. family: empty for all.
  std::array<std::size_t, 4> counts(const std::string& family = "") const;
  std::array<std::size_t, 5> method_counts(std::size_t method) const;
  std::size_t count(HardVerdict verdict) const { return counts()[static_cast<std::size_t>(verdict)]; }
};

/// The stages of a run, for a command that has no others.
std::vector<Stage> hard_stages(const HardOptions& options);

/// Solves and judges. A certified answer becomes wrong where an equivalent scene has another one, or a finer
/// mesh one beyond its uncertainty.
HardResult run_hard_cases(const std::vector<HardCase>& cases, const HardOptions& options, const ProcessPool& pool);

/// docs/schema/hard.schema.json
Json to_json(const HardResult& result);
/// Its key `counts`.
Json counts_json(const HardResult& result);

/// For a person: counts of each family, then the cases that are wrong or did not converge, with the command
/// that repeats each.
std::string hard_text(const HardResult& result);

}  // namespace slipstick::convergence
