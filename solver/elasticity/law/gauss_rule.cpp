#include "solver/elasticity/law/gauss_rule.hpp"

#include <gsl/gsl_integration.h>

#include <cstddef>
#include <memory>

namespace slipstick::solver {

GaussRule make_gauss_rule(int points) {
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(static_cast<std::size_t>(points)),
      gsl_integration_glfixed_table_free);
  GaussRule rule;
  for (int i = 0; i < points; ++i) {
    double node = 0.0;
    double weight = 0.0;
    gsl_integration_glfixed_point(-0.5, 0.5, static_cast<std::size_t>(i), &node, &weight, table.get());
    rule.node.push_back(node);
    rule.weight.push_back(weight);
  }
  return rule;
}

}  // namespace slipstick::solver
