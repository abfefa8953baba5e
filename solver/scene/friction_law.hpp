#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// How the shear that friction carries follows from the pressure p of a cell: mu p; a strength wherever there
/// is pressure; the lesser of the two; k p^n.
enum class FrictionKind { coulomb, tresca, capped, power };

/// The law's name, as "Coulomb's law", and its bound on the shear, as "mu p".
std::string law_text(FrictionKind kind);
std::string bound_text(FrictionKind kind);

/// A friction law: in a cell under the pressure p > 0 the shear traction is at most a bound, |q| <= f(p), and
/// at the bound it opposes the slip. Stresses in Pa, or in any one unit.
struct FrictionLaw {
  FrictionLaw() = default;
  FrictionLaw(double mu) : coefficient(mu) {}  // NOLINT(google-explicit-constructor): Coulomb's law is a number

  FrictionKind kind = FrictionKind::coulomb;
  double coefficient = 0.0;                         ///< coulomb, capped: mu; power: k, stress^(1 - exponent)
  double shear_strength = 0.0;                      ///< tresca, capped
  double exponent = 1.0;                            ///< power: n
  std::filesystem::path map{};                      ///< file of a factor of the bound for each cell; empty: none
  std::shared_ptr<const Eigen::ArrayXd> factors{};  ///< what it holds; null: 1 everywhere

  bool is_coulomb() const { return kind == FrictionKind::coulomb && map.empty() && !factors; }

  /// Whether no pressure makes any friction.
  bool is_frictionless() const { return kind != FrictionKind::tresca && coefficient == 0.0; }

  /// f of a pressure, without the map's factor. Zero where p is.
  double bound(double pressure) const;

  /// f of each cell.
  Eigen::ArrayXd bound(const Eigen::ArrayXd& pressure) const;

  /// f of a cell.
  double bound(const Eigen::ArrayXd& pressure, Index cell) const {
    return (factors ? (*factors)[cell] : 1.0) * bound(pressure[cell]);
  }

  /// The same law of stresses that are counted in another unit.
  FrictionLaw to_dimensionless(double stress_unit) const;
};

/// The law with the factors that its map holds for the cells of a grid, or without a map where all are 1.
/// Throws InputError for a file that
/// cannot be read, for factors that are negative or no numbers, and for more or fewer of them than cells.
FrictionLaw with_factors(FrictionLaw law, const Grid& grid);

/// A law with a map for one grid, with a map for another: each cell takes the mean over it. centre: of `to`
/// in the coordinates of `from`, in the unit of both.
FrictionLaw resampled(FrictionLaw law, const Grid& from, const Grid& to, const std::array<double, 2>& centre = {});

}  // namespace slipstick::solver
