#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `law` to the program: the contact law of a scene or a profile, as other programs want it.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_law_command(CLI::App& app);

}  // namespace slipstick::convergence
