#pragma once

#include <string>
#include <vector>

#include "convergence/gates/gate.hpp"
#include "convergence/results/markup.hpp"

/// What became of gates, for those who read it: a person, a CI server, a script.
namespace slipstick::convergence {

/// For a person: a line a gate, then what there is to know of each that does not pass, and the count.
std::string gates_text(const std::vector<Judgement>& judgements);

/// JUnit's XML, as CI servers read it: a suite a file, a case a gate. Refused gates are errors; reported and
/// expected failures are skipped.
std::string gates_junit(const std::vector<Judgement>& judgements);

/// A Markdown table, the worst first, shorter than kMaxMarkdown bytes: what does not fit is counted.
std::string gates_markdown(const std::vector<Judgement>& judgements);

/// Workflow commands of GitHub Actions, which put a message at the gate's line in its file: an error for each
/// gate that fails or is refused.
std::string gates_annotations(const std::vector<Judgement>& judgements);

/// Every gate with value, bound, factor, outcome, and the counts.
Json gates_json(const std::vector<Judgement>& judgements);

}  // namespace slipstick::convergence
