#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::solver {
class Ranks;
}

namespace slipstick::convergence {

/// Runs a command: writes text for a person to the stream, fills the result, and returns the exit code.
/// Throws InputError for mistakes of the user.
using RunCommand = std::function<int(std::ostream&, nlohmann::ordered_json&)>;

/// Adds `check` to the program: judges a traction field that any program computed. Exit code 0 for a good
/// field, 1 for a bad one.
RunCommand add_check_command(CLI::App& app);
/// Adds `digits`: counts the digits of a scene's result that rounding does not change.
RunCommand add_digits_command(CLI::App& app);
/// Adds `gate`. Exit code 0 where all gates pass, 1 where one fails, 2 where one could not be judged.
RunCommand add_gate_command(CLI::App& app);
/// Adds `hard`: solves and judges hundreds of hard scenes, each also in equivalent forms.
RunCommand add_hard_command(CLI::App& app);
/// Adds `report`: runs the solves and studies of the page and draws it.
RunCommand add_report_command(CLI::App& app);
/// Adds `run`: solves the runs that another command has listed.
RunCommand add_run_command(CLI::App& app);
/// Adds `solve`. Exit code 1 where the solve did not reach its tolerance.
/// ranks: the processes that share the solve.
RunCommand add_solve_command(CLI::App& app, const solver::Ranks& ranks);
/// Adds `study`: solves a scene on many meshes, to many tolerances or with varied keys, and judges the results.
RunCommand add_study_command(CLI::App& app);

}  // namespace slipstick::convergence
