#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/gates/gate.hpp"
#include "convergence/hard/hard_run.hpp"
#include "convergence/report/page.hpp"
#include "convergence/runs/process_pool.hpp"

/// Section 5 of the paper (Figs. 1-5) for its scene against the exact solution:
///
/// 1. profiles, loading curve and mesh study of the sphere; an elliptic contact, where the paper's method
///    fails; other laws of friction;
/// 2. the hard cases by each method, fields of other programs, published numbers, the accuracy gates;
/// 3. a finding for each part of 2.
namespace slipstick::convergence {

/// A field of another program whose verdict is known. check: numbers that `check` finds.
struct KnownField {
  std::string program = {};
  std::string file = {};
  std::string expected = {};
  std::string verdict = {};
  Json check = {};
};

/// The paper's validation. figures: the keys of the data that are only drawn.
struct PaperValidation {
  Json figures = {};
  HardResult hard = {};
  std::vector<KnownField> peers = {};
  std::vector<Judgement> literature = {};
  std::optional<std::vector<Judgement>> gates = {};  ///< none on a quick page
};

/// The stages of validate().
std::vector<Stage> validation_stages(const Validation& request);

/// Writes the fields that the page draws into `folder`. Throws std::runtime_error where a run has no result,
/// and as the pool does.
PaperValidation validate(const Validation& request, const std::filesystem::path& folder, const ProcessPool& pool);

/// Gates hold, unless they are omitted; no hard case is wrong; `check` finds the known verdicts of fields of
/// other programs; published numbers agree.
std::vector<Finding> judge_validation(const PaperValidation& paper);

/// Numbers of hard cases and gates by their verdicts.
Json counts_json(const PaperValidation& paper);
Json to_json(const PaperValidation& paper);

}  // namespace slipstick::convergence
