#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::analytic {

/// Adds `exact` to the program. The function returned runs it: it writes what a person reads to the stream,
/// fills the result, and returns the exit code. Throws, with the option, for values out of range.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_exact_command(CLI::App& app);

}  // namespace slipstick::analytic
