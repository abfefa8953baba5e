#include "bench/compare/second_run.hpp"

#include <fmt/core.h>

#include <string_view>

#include "bench/compare/benchmark_program.hpp"
#include "convergence/programs/run_program.hpp"
#include "convergence/results/markup.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

using solver::InputError;

constexpr std::string_view kPlace = "{filter}";

std::string with_filter(const std::string& line, const std::string& filter, const std::string& option) {
  const std::string word = convergence::shell_word(filter);
  std::string command = " " + line;  // so that something stands before every place
  for (std::size_t at = command.find(kPlace); at != std::string::npos; at = command.find(kPlace, at)) {
    const std::string around = command.substr(at - 1, kPlace.size() + 2);
    if (around.find_first_of("'\"") != std::string::npos) {
      throw InputError(option, "write {filter} without quotes: it comes with its own");
    }
    command.replace(at, kPlace.size(), word);
    at += word.size();
  }
  return command;
}

}  // namespace

ComparisonReport compare_twice(const TwoTimings& first, const ComparisonRules& rules, const Again& again) {
  ComparisonReport report{
      first.base.file.string(), first.now.file.string(), rules, compare(first, rules), {}};
  state_power(report.comparison, first, rules);
  const std::vector<std::string> names = suspicious(report.comparison);
  if (names.empty() || !again) return report;
  ComparisonRules with_waiting = rules;
  with_waiting.waiting = report.comparison.waiting;
  with_waiting.second_run = 0;
  try {
    const TwoTimings second = select(again(names), names);
    report.second = compare(second, with_waiting);
    state_power(*report.second, second, with_waiting);
  } catch (const InputError& error) {
    report.second.emplace().obstacles.emplace_back(error.what());
  }
  report.comparison = confirm(report.comparison, *report.second);
  return report;
}

Timings run_again(const std::string& command, const std::vector<std::string>& names) {
  const std::string option = fmt::format("--rerun {}", command);
  const convergence::ProgramEnd end =
      convergence::run_program({"sh", "-c", with_filter(command, benchmark_filter(names), option)},
                               {.captured = convergence::Captured::output});
  if (end.code != 0) throw InputError(option, fmt::format("ended with {}", end.code));
  return parse_timings(end.output, "second run");
}

}  // namespace slipstick::bench
