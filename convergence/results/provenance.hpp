#pragma once

#include <nlohmann/json_fwd.hpp>

namespace slipstick::convergence {

/// What made a result: version, commit, compiler, flags, libraries, processor, threads.
nlohmann::ordered_json provenance(int threads);

}  // namespace slipstick::convergence
