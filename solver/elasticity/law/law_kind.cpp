#include "solver/elasticity/law/law_kind.hpp"

#include "solver/elasticity/law/winkler_layer.hpp"

namespace slipstick::solver {

const std::vector<LawKind>& law_kinds() {
  static const std::vector<LawKind> kinds{WinklerLayer::kind()};
  return kinds;
}

}  // namespace slipstick::solver
