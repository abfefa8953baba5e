#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `check` to the program: judges a traction field that any program computed. The function returned
/// gives exit code 0 for a good field, 1 for a bad one.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_check_command(CLI::App& app);

}  // namespace slipstick::convergence
