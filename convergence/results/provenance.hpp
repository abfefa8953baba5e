#pragma once

#include <nlohmann/json_fwd.hpp>

namespace slipstick::convergence {

/// How a result was made: version, commit, compiler, flags, libraries, processor, threads.
nlohmann::ordered_json provenance(int threads);

}  // namespace slipstick::convergence
