#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"

/// The uncertainty of a result by that of its inputs, which vary independently of each other.
namespace slipstick::convergence {

/// A number of a scene with its uncertainty.
struct UncertainInput {
  std::string key;  ///< contact.friction, say
  double value;     ///< what the scene says
  double relative;  ///< standard uncertainty over the value
};

/// Reads "key=5%". A key without its table stands for all numbers of that name in upper, lower, contact and
/// load. Throws InputError for keys that are no numbers of the scene, or zero, and for other percentages than
/// those above 0 and below 100.
std::vector<UncertainInput> uncertain_inputs(const std::filesystem::path& scene,
                                             const std::vector<std::string>& overrides,
                                             const std::vector<std::string>& words);

/// The result of the scene with these overrides too. Throws InputError where there is none.
using SolveWith = std::function<Json(const std::vector<std::string>& overrides)>;

/// Each output's standard uncertainty to first order, the part of each input and the numerical error, all
/// relative, and a sentence that says which matters. Derivatives are central differences: of an exact answer,
/// where the result knows it, over 1e-5, which leaves 1e-10 of them; else over 2 % of solves on at most 64
/// cells a side, of which the mesh's scatter is a small part. Steps shrink where the loads would be beyond
/// the limit. Throws InputError where all steps are.
///
/// "draws" are made where this does not do: where an input alone moves an output at one standard uncertainty
/// otherwise than its derivative says, by a tenth of the output's standard uncertainty, or leaves no answer
/// at three. They are the same in each run, from normal distributions; their parts without an answer stand
/// there, and "quantiles" of the others at the outputs.
Json uncertainty_json(const Json& result, const std::vector<UncertainInput>& inputs, const SolveWith& solve);

/// The same for a person: one line an output, and the sentence.
std::string uncertainty_text(const Json& result);

}  // namespace slipstick::convergence
