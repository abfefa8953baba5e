#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace slipstick::convergence {

/// What `check` says of fields that other programs computed for the paper's sphere and whose worth is known:
/// a row for each, with its program, the verdict and the one that is expected. `inputs` has the scenes
/// (scenes/) and the fields (check/fields/).
nlohmann::ordered_json judge_peers(const std::filesystem::path& inputs);

}  // namespace slipstick::convergence
