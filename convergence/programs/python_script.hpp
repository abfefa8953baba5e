#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"

/// Figures and pages are drawn by the Python scripts of reports/.
namespace slipstick::convergence {

/// A file of the project: from share/slipstick of the program's installation, or from its source tree.
std::filesystem::path project_file(const std::filesystem::path& relative);

/// Runs a script of reports/ with python_interpreter() and waits. Throws std::runtime_error if the script
/// fails; the message begins with `done`, the work that is complete.
void run_report_script(const std::string& script, const std::vector<std::string>& arguments, const std::string& done);

/// Throws InputError, which names the option, unless a figure can have this ending and its folder exists.
void require_figure_format(const std::filesystem::path& figure, const std::string& option = "--figure");

/// Draws slip and stick, tractions and pressure of a result; of a history its loop too. cells: the file of
/// its fields, in a temporary folder, into which the result is written too; with "{step}" in its name, as in
/// the figure's, a file of each step. Throws as run_report_script().
void draw_solve(const std::filesystem::path& figure, const Json& result, const std::filesystem::path& cells);

/// Draws the stresses of a volume, as `solve --stresses` writes it. Throws as run_report_script().
void draw_stresses(const std::filesystem::path& figure, const std::filesystem::path& volume);

/// Draws errors, orders and budget of a study's result. Throws as run_report_script().
void draw_study(const std::filesystem::path& figure, const Json& result);

}  // namespace slipstick::convergence
