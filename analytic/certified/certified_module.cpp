#include "analytic/certified/certified.hpp"

/// libslipstick_certified: ball arithmetic, and FLINT behind it.
namespace slipstick::analytic::certified {

extern "C" [[gnu::visibility("default")]] decltype(state)* slipstick_certified() { return &state; }

}  // namespace slipstick::analytic::certified
