#pragma once

#include <nlohmann/json_fwd.hpp>

namespace slipstick::convergence {

/// What the page shows of the exact side alone, no solve needed: for the sphere `curve` (stick radius and
/// twist against moment), `equation_5_digits`, `approximations` (errors of laws in use) and
/// `approximation_table`; for sphere, cone and flat punch `bodies`; `loop` (a history with an inner loop) and
/// `cycle_energy`.
nlohmann::ordered_json exact_curves();

}  // namespace slipstick::convergence
