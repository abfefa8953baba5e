#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::bench {

/// Adds `compare` to the program. The function returned runs it: it writes what a person reads to the stream,
/// fills the result, and returns the exit code: 0 nothing is slower, 1 something is, 2 it could not be
/// judged.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_compare_command(CLI::App& app);

}  // namespace slipstick::bench
