#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/result_parts.hpp"

/// Figures and pages are drawn by the Python scripts of reports/.
namespace slipstick::convergence {

/// A file of the project: from share/slipstick of the program's installation, or from its source tree.
std::filesystem::path project_file(const std::filesystem::path& relative);

/// Runs a script of reports/ and waits. Throws std::runtime_error if no suitable Python was found when the
/// program was built, or if the script fails; the message begins with `done`, the work that is complete.
void run_report_script(const std::string& script, const std::vector<std::string>& arguments,
                       const std::string& done);

/// Throws InputError unless a figure can have this ending and its folder exists.
void require_figure_format(const std::filesystem::path& figure);

/// Files of the cells in the folder that draw_solve() takes: of the last step, and of each step.
inline constexpr const char* kFieldsFile = "fields.h5";
inline constexpr const char* kFieldsOfSteps = "fields-{step}.h5";

/// Draws slip and stick, tractions and pressure of a result, whose cells are in kFieldsFile of the folder, or
/// of each step where the figure's name holds "{step}"; of a history its loop too. The result is written to
/// the folder. Throws as run_report_script().
void draw_solve(const std::filesystem::path& figure, const Json& result, const TemporaryFolder& folder);

/// Draws errors, orders and budget of a study's result. Throws as run_report_script().
void draw_study(const std::filesystem::path& figure, const Json& result);

}  // namespace slipstick::convergence
