#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/law/hankel_table.hpp"
#include "solver/elasticity/law/layer_symbol.hpp"

namespace slipstick::solver {

/// Two half-spaces, each with or without a layer bonded to it. The tables are those of half-spaces of the
/// layers' constants, and what the bases change: radial functions (Hankel transforms of the symbol), smooth
/// since the bases lie below the surface, averaged over each cell by Gauss points. They are within 1e-13 of
/// the largest coefficient of half-spaces that are all layer, or all base if that is larger.
class CoatedHalfSpaces final : public ElasticLaw {
 public:
  /// One of the surfaces is elastic; each layer has a positive, finite thickness.
  CoatedHalfSpaces(const CoatedBody& lower, const CoatedBody& upper,
                   CellTraction cell_traction = CellTraction::constant);

  std::vector<std::vector<double>> influence_tables(std::span<const Component> components,
                                                    const Grid& offsets, int threads = 1) const override;

  /// The exact inverse of what wave_compliance() says along and across a wave's vector.
  void inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                       std::span<Symbol> inverses) const override;

  /// 0.9 times the least compliance of a wave that the cells can carry. The waves that cells alias raise the
  /// eigenvalue, or leave it where each cell stands alone, on a thin layer. Computed, it is 1.11 to 2.8 times
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
