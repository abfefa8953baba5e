#include "solver/scene/friction_law.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "solver/grid/grid_transfer.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/to_dimensionless.hpp"

namespace slipstick::solver {

using Eigen::ArrayXd;

namespace {

/// By FrictionKind.
constexpr std::array kLaws{"Coulomb's law", "Tresca's law", "the capped law of friction", "the power law of friction"};
constexpr std::array kBounds{"mu p", "the shear strength", "mu p or the shear strength", "k p^n"};

}  // namespace

std::string law_text(FrictionKind kind) { return kLaws[static_cast<std::size_t>(kind)]; }
std::string bound_text(FrictionKind kind) { return kBounds[static_cast<std::size_t>(kind)]; }

double FrictionLaw::bound(double pressure) const {
  if (!(pressure > 0.0)) return 0.0;
  switch (kind) {
    case FrictionKind::coulomb:
      return coefficient * pressure;
    case FrictionKind::tresca:
      return shear_strength;
    case FrictionKind::capped:
      return std::min(coefficient * pressure, shear_strength);
    case FrictionKind::power:
      return coefficient * std::pow(pressure, exponent);
  }
  return NAN;
}

ArrayXd FrictionLaw::bound(const ArrayXd& pressure) const {
  if (is_coulomb()) return coefficient * pressure;
  ArrayXd bounds = pressure.unaryExpr([this](double p) { return bound(p); });
  if (factors) bounds *= *factors;
  return bounds;
}

FrictionLaw FrictionLaw::to_dimensionless(double stress_unit) const {
  FrictionLaw law = *this;
  if (kind == FrictionKind::power)
    law.coefficient = solver::to_dimensionless(coefficient, std::pow(stress_unit, 1.0 - exponent));
  law.shear_strength = solver::to_dimensionless(shear_strength, stress_unit);
  return law;
}

FrictionLaw with_factors(FrictionLaw law, const Grid& grid) {
  if (law.map.empty() || law.factors) return law;
  const Eigen::ArrayXXd map = read_matrix(law.map, "friction");
  if (map.rows() != grid.n1 || map.cols() != grid.n2) {
    throw InputError(law.map.string(),
                     fmt::format("{} x {} factors of the friction; allowed: {} x {}, one a cell of the grid",
                                 map.rows(), map.cols(), grid.n1, grid.n2));
  }
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      if (map(i, j) >= 0.0 && std::isfinite(map(i, j))) continue;
      throw InputError(law.map.string(), fmt::format("row {}, column {}: {}; allowed: zero or positive, finite", i + 1,
                                                     j + 1, map(i, j)));
    }
  }
  if ((map == 1.0).all()) {
    law.map.clear();
  } else {
    law.factors = std::make_shared<const ArrayXd>(map.reshaped<Eigen::RowMajor>());
  }
  return law;
}

FrictionLaw resampled(FrictionLaw law, const Grid& from, const Grid& to, const std::array<double, 2>& centre) {
  if (!law.factors) return law;
  law.factors = std::make_shared<const ArrayXd>(means_on(to, from, *law.factors, centre));
  return law;
}

}  // namespace slipstick::solver
