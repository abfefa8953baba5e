#pragma once

#include <nlohmann/json.hpp>

namespace slipstick::convergence {

/// What made a result: version, commit, compiler, flags, libraries, processor, threads.
nlohmann::ordered_json provenance(int threads);

}  // namespace slipstick::convergence
