#include "solver/newton/conjugate_gradients.hpp"

#include <fmt/core.h>

namespace slipstick::solver {

std::string CgSummary::message() const {
  switch (status) {
    case CgStatus::indefinite:
      return fmt::format("curvature {:.3g} along a search direction", breakdown_at);
    case CgStatus::not_finite:
      return fmt::format("a residual whose square is {:.3g}", breakdown_at);
    default:
      return "";
  }
}

}  // namespace slipstick::solver
