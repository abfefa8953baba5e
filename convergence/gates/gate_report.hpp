#pragma once

#include <string>
#include <vector>

#include "convergence/gates/gate.hpp"

/// Judgements for people and for CI servers.
namespace slipstick::convergence {

/// One line for each gate, then the details of each gate that is wrong, then the counts.
std::string gates_text(const std::vector<Judgement>& judgements);

/// Gates that were not run, as refuse() makes judgements of them: one line for each with id, file, quantity
/// and bound; a gate file that cannot be read with the reason.
std::string list_text(const std::vector<Judgement>& gates);

/// {listed: [a row for each gate, without outcome and value, with its scene, study or result]}.
Json list_json(const std::vector<Judgement>& gates);

/// JUnit's XML: one suite for each file, one case for each gate. Refused gates are errors; reported gates and
/// expected failures are skipped.
std::string gates_junit(const std::vector<Judgement>& judgements);

/// A Markdown table, the worst gate first, shorter than kMaxMarkdown bytes: rows that do not fit are counted.
std::string gates_markdown(const std::vector<Judgement>& judgements);

/// {outcome: number}.
Json counts_json(const std::vector<Judgement>& judgements);

/// {exit_code, counts: {outcome: number}, gates: [a row for each judgement]}.
Json gates_json(const std::vector<Judgement>& judgements);

}  // namespace slipstick::convergence
