#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"

/// Files that list runs: a JSON object on each line. Any program may distribute the lines over machines.
namespace slipstick::convergence {

/// A run as JSON, without the members that have their defaults.
Json to_json(const RunSpec& spec);

/// The run of a JSON object. Throws InputError with `source`, key, value and the allowed values.
RunSpec run_of(const Json& json, const std::string& source);

/// A line of a list.
struct ListedRun {
  std::size_t line;  ///< counted from 1
  PreparedRun run;
  std::filesystem::path folder;  ///< keeps the result
};

/// The lines of a list; equal runs have one line.
std::string run_list_text(const std::vector<PreparedRun>& runs, const std::filesystem::path& folder);

/// only: the number of a line; 0: all lines. Throws InputError for a line that is no run, and for one whose
/// scene has changed since.
std::vector<ListedRun> read_run_list(const std::filesystem::path& file, std::size_t only = 0);

}  // namespace slipstick::convergence
