#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `report` to the program: runs what the page needs and has it drawn.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_report_command(CLI::App& app);

}  // namespace slipstick::convergence
