#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/work/work_counts_cases.hpp"

namespace slipstick::bench {

/// Instructions executed, by the file that holds them: the program, each shared library.
using Instructions = std::map<std::string, long>;

/// The counts of callgrind's first event in a file. Throws std::runtime_error for a file of another kind, or
/// where the parts do not add up to the total that it states.
Instructions read_callgrind(const std::filesystem::path& file);

/// Does the work of a case once; run_callgrind() does not count its preparation.
void do_case(const WorkCase& work_case);

/// Runs `PROGRAM --do CASE` for each case under callgrind, as many at a time as there are processors.
/// Returns none without valgrind. Throws std::runtime_error where a run fails.
std::optional<std::map<std::string, Instructions>> run_callgrind(const std::filesystem::path& program,
                                                                 const std::vector<WorkCase>& cases);

}  // namespace slipstick::bench
