#pragma once

#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/results/markup.hpp"

/// The findings on which the verdict of a page rests, its headline, and the changes since the page before.
namespace slipstick::convergence {

struct HardResult;
struct StudyResult;

/// The solve converged and its gap is within the tolerance.
Finding judge_certificate(const Json& answer);

/// Another program: the verdict of `check` on its field; its pressure, if it finds only that; its answers to
/// hard variants against this program's answers.
Finding judge_check(const Json& answer, const Json& check);
Finding judge_pressure(const Json& answer);
Finding judge_hard_beside(const HardResult& hard);

/// The error of the number by which answers are compared; open from solver::kPoorlyResolved on.
Finding judge_accuracy(const std::vector<PageNumber>& numbers, const std::string& number);

/// The largest relative error that the user accepts for a number of the result.
struct WantedError {
  std::string quantity;  ///< key of a number of the result, twist_angle; "twist" is short for it
  double error;
};
/// "twist=1e-3". Throws InputError for anything else, and for an error that is not between 0 and 1.
WantedError read_wanted_error(const std::string& word);

/// Throws InputError for a quantity that is no number of the page.
Finding judge_wanted(const WantedError& wanted, const std::vector<PageNumber>& numbers);

/// The order of that number in the study of meshes is not below the expected one; open where the meshes do
/// not show it. words: for the number.
Finding judge_order(const StudyResult& study, const std::string& number, const std::string& words);

/// No hard case is wrong or unconverged. what: title of the cases, as "Hard variants".
Finding judge_hard(const HardResult& hard, const std::string& what);

/// counts: of hard cases and gates.
Headline headline_of(std::vector<Finding> findings, Json counts, const Page& page);

/// The changes of verdict, counts and numbers since an earlier headline, a sentence each; times do not count.
std::vector<std::string> changes(const Headline& now, const Json& before);

/// The headline with `since` and `changes` against an earlier one, which may be null. If nothing has changed,
/// both keep their earlier values.
Headline with_changes(Headline now, const Json& before);

/// For a person, ten lines at most.
std::string headline_text(const Headline& headline);

/// A case for each finding.
std::vector<JunitCase> page_cases(const Page& page);

}  // namespace slipstick::convergence
