#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds the command `reference`, which --help hides: it writes the pages of docs/reference, the manual page
/// and the completion that are made from the program itself. The returned function is to be called after
/// parsing if the command was given; it throws InputError where a file cannot be written, and returns the
/// exit code.
std::function<int(std::ostream& text, nlohmann::ordered_json& result)> add_reference_command(CLI::App& app);

}  // namespace slipstick::convergence
