#pragma once

#include <string>
#include <vector>

#include "convergence/report/scene_page.hpp"

/// The verdict of a page, and what differs from the page before.
namespace slipstick::convergence {

/// open: nothing is wrong, and nothing is shown either.
enum class Shown { holds, open, fails };
inline Shown shown(bool holds) { return holds ? Shown::holds : Shown::fails; }

/// A sentence of the verdict, and whether it holds.
struct Finding {
  std::string what;
  std::string line;
  Shown shown = Shown::holds;
};

/// Converged, and its gap within the tolerance.
Finding judge_certificate(const Json& answer);

/// Another program: what `check` says of its field; its pressure, where it found that alone; and its
/// answers to hard variants beside this program's.
Finding judge_check(const Json& answer, const Json& check);
Finding judge_pressure(const Json& answer);
Finding judge_hard_beside(const Json& hard);

/// How far the number by which answers are compared may be off, by its mesh and by the length of its steps;
/// open from solver::kPoorlyResolved on.
Finding judge_accuracy(const Json& numbers, const std::string& number);

/// Throws InputError for a quantity that no row of the numbers has.
Finding judge_wanted(const WantedError& wanted, const Json& numbers);

/// The order of that number in the study of meshes is no worse than expected; open where the meshes do not
/// show it. words: for the number.
Finding judge_order(const Json& studies, const std::string& number, const std::string& words);

/// No hard case is wrong or does not converge. what: the cases, as "Hard variants".
Finding judge_hard(const Json& hard, const std::string& what);

/// What validate() found, where it was asked: gates hold, unless they were left out; no hard case ends wrong;
/// fields of other programs are judged as they deserve.
std::vector<Finding> judge_validation(const Json& paper);

/// The head of a page: {verdict, commit, lines, numbers, counts}. The verdict is bad where a finding
/// fails, else open where one is open, else good.
Json headline_of(const std::vector<Finding>& findings, const Json& page);

/// Sentences on what differs from an earlier headline: none where only times do.
Json changes(const Json& now, const Json& before);

/// The headline beside an earlier one, which may be null: `since` says which page that was and `changes` what
/// is different now. What an earlier page said of its own predecessor stays where nothing is different.
Json with_changes(Json now, const Json& before);

/// For a person, ten lines at most.
std::string headline_text(const Json& headline);

}  // namespace slipstick::convergence
