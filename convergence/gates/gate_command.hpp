#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `gate` to the program. The function returned runs it: it writes what a person reads to the stream,
/// fills the result, and returns the exit code: 0 all gates pass, 1 one fails, 2 one could not be judged.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_gate_command(CLI::App& app);

}  // namespace slipstick::convergence
