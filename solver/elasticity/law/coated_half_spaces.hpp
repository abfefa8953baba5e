#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/law/hankel_table.hpp"
#include "solver/elasticity/law/layer_symbol.hpp"

namespace slipstick::solver {

/// Two half-spaces, each with or without a bonded layer. Influence tables are the sum of two parts:
///
/// 1. the tables of half-spaces with the layers' constants;
/// 2. the change by the bases: radial functions (Hankel transforms of the symbol), which are smooth since the
///    bases lie below the surface, averaged over each cell by Gauss points.
///
/// The error is within 1e-13 of the largest coefficient of half-spaces of the layer's constants, or of the
/// base's if that is larger.
class CoatedHalfSpaces final : public ElasticLaw {
 public:
  /// One of the surfaces is elastic; each layer has a positive, finite thickness.
  CoatedHalfSpaces(const CoatedBody& lower, const CoatedBody& upper,
                   CellTraction cell_traction = CellTraction::constant);

  Tables influence_tables(std::span<const Component> components, const Grid& offsets, int threads = 1) const override;

  /// The exact inverse of wave_compliance() along and across a wave's vector.
  void inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                       std::span<Symbol> inverses) const override;

  /// 0.9 times the least compliance of a wave that the cells resolve. Aliased waves raise the eigenvalue, or
  /// leave it, on a thin layer, where cells are independent. The computed eigenvalue is 1.11 to 2.8 times
  /// this number for ratios of moduli from 1e-4 to infinity, Poisson's ratios from -0.9 to 0.5, layers from
  /// 1e-3 to 1e3 cells, sides up to 1 : 20.
  double least_eigenvalue(double h1, double h2) const override;

  bool couples() const override { return couples_; }
  void add_to(CacheKey& key) const override;

 private:
  WaveCompliance compliance(double wave_number) const;
  HankelTable::Values beyond_layers(double x) const;

  CoatedBody lower_, upper_;
  HalfSpaces layers_;  ///< of cells of constant traction
  CellTraction cell_traction_;
  double thickness_;  ///< of the thinner layer; infinite without one
  bool couples_;
  std::optional<HankelTable> radial_;  ///< in units of the thickness; none without a layer
};

}  // namespace slipstick::solver
