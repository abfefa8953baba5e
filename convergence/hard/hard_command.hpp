#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `hard` to the program: hard scenes by the hundred, each solved, seen otherwise and judged.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_hard_command(CLI::App& app);

}  // namespace slipstick::convergence
