#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `solve` to the program. The function returned runs it: it writes what a person reads to the stream,
/// fills the result, and returns the exit code: 0, or 1 if the solve did not reach its tolerance.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_solve_command(CLI::App& app);

}  // namespace slipstick::convergence
