#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "convergence/results/solve_record.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/scene_file.hpp"

/// The uncertainty of a result by the uncertainty of its inputs, which vary independently of each other.
namespace slipstick::convergence {

/// The part of one input in an output's uncertainty.
struct UncertainPart {
  std::string key;
  double exponent;  ///< d ln output / d ln input
  double part;      ///< exponent times the input's relative uncertainty
};

/// A number of the result. Uncertainties and errors are relative unless said.
struct UncertainOutput {
  std::string name;   ///< path in the result
  std::string words;  ///< name for a person
  double value;
  double standard = 0.0;  ///< standard uncertainty to first order, in the unit of the value
  double relative = 0.0;
  double numerical;                                         ///< error of mesh and steps; NaN: not known
  std::vector<UncertainPart> parts = {};                    ///< one for each input
  std::vector<std::pair<std::string, double>> quantiles{};  ///< 5 %, 50 %, 95 % of the draws; empty: none
};

/// Random draws of all inputs from normal distributions; the same in each run.
struct Draws {
  std::size_t number;
  bool exact;            ///< solved exactly; else on at most 64 cells a side
  double sliding = 0.0;  ///< part of the draws in gross slip
  double failed = 0.0;   ///< part that fails for other reasons
  std::string failed_reason = {};
};

struct Uncertainty {
  bool exact;  ///< the result is the exact answer
  std::vector<UncertainInput> inputs;
  std::vector<double> steps = {};  ///< relative, of each input's central difference
  std::vector<UncertainOutput> outputs = {};
  std::optional<Draws> draws = {};
  std::string sentence = {};  ///< names the input that matters most
};

/// The uncertainty of a converged result of the scene.
///
/// 1. Central differences over a relative step of 1e-5 of exact answers where the result knows one, whose error
///    is 1e-10; else over 2 % of solves on at most 64 cells a side, on which the mesh's scatter is small. A
///    step is quartered where a load passes the limit.
/// 2. Sums the squares of the inputs' parts.
/// 3. Draws all inputs where first order does not hold: if one input at one standard uncertainty moves an output
///    by another amount than its derivative predicts, by a tenth of the output's standard uncertainty, or if
///    there is no answer at three.
///
/// Throws InputError where no step of an input has an answer.
Uncertainty uncertainty_of(const SolveRecord& result, const std::vector<UncertainInput>& inputs, const SceneFile& scene,
                           const SolveSceneOptions& options);

Json to_json(const Uncertainty& uncertainty);

/// The same for a person: one line an output, and the sentence.
std::string uncertainty_text(const Uncertainty& uncertainty);

}  // namespace slipstick::convergence
