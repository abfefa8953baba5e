#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Adds `study` to the program: a scene on many meshes, to many tolerances, with varied keys, judged.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_study_command(CLI::App& app);

}  // namespace slipstick::convergence
