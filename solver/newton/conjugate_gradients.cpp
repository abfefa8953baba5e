#include "solver/newton/conjugate_gradients.hpp"

#include <fmt/core.h>

namespace slipstick::solver {

std::string CgSummary::message() const {
  const double at = std::isnan(breakdown_at) ? std::abs(breakdown_at) : breakdown_at;  // its sign says nothing
  switch (status) {
    case CgStatus::indefinite:
      return fmt::format("curvature {:.3g} along a search direction", at);
    case CgStatus::not_finite:
      return fmt::format("a residual whose square is {:.3g}", at);
    default:
      return "";
  }
}

}  // namespace slipstick::solver
