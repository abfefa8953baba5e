#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>

namespace slipstick::convergence {

/// Adds `report` to the program: runs what the page needs and has it drawn.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_report_command(CLI::App& app);

}  // namespace slipstick::convergence
