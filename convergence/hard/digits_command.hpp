#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `slipstick digits`. Returns what runs it: writes text, fills the result, returns the exit code.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_digits_command(CLI::App& app);

}  // namespace slipstick::convergence
