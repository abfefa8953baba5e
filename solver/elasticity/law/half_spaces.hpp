#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"
#include "solver/elasticity/operator_kind.hpp"

namespace slipstick::solver {

/// Elastic half-space. shear_modulus may be infinite: a rigid body.
struct HalfSpace {
  double shear_modulus;
  double poisson_ratio;
};

/// The constants of a pair of half-spaces. Compliances add in K11, K12, K22, K33 and subtract in K13, K23.
struct ElasticPair {
  double shear_compliance;    ///< 1/G = sum of 1/G_i
  double poisson_compliance;  ///< sum of nu_i/G_i
  double normal_compliance;   ///< sum of (1 - nu_i)/G_i = 2/E*
  double mismatch;            ///< (1 - 2 nu)/G, lower less upper; 0 for similar materials

  double effective_modulus() const { return 2.0 / normal_compliance; }
  double shear_modulus() const { return 1.0 / shear_compliance; }
};

ElasticPair elastic_pair(const HalfSpace& lower, const HalfSpace& upper);

/// Two half-spaces (Boussinesq, Cerruti; Love 1929; Johnson 1985, section 3.6).
class HalfSpaces final : public ElasticLaw {
 public:
  explicit HalfSpaces(const ElasticPair& pair, CellTraction cell_traction = CellTraction::constant)
      : pair_(pair), cell_traction_(cell_traction) {}

  /// One pass over the offsets serves all components, and square cells need only offsets on one side of the diagonal.
  ///
  /// With CellTraction::smooth, 1/24 of its second differences along both axes is subtracted from each
  /// coefficient: constant tractions reduce a wave of wave vector xi by the factor
  /// 1 - (xi_1^2 h1^2 + xi_2^2 h2^2)/24, which this corrects for any contact shape.
  Tables influence_tables(std::span<const Component> components, const Grid& offsets, int threads = 1) const override;

  /// Tractions of wave vector xi, n = xi/|xi|, move the surface by (S I - N n n^T)/|xi| times them along it
  /// and by C33/|xi| times them across (transforms of the solutions of Cerruti and Boussinesq: 1/r becomes
  /// 2 pi/|xi|, and r_i r_j/r^3 becomes 2 pi (I - n n^T)/|xi|). S and N are the shear and the Poisson
  /// compliance, C33 the normal one. The first has the inverse |xi| (I + N/(S - N) n n^T)/S. The symbol of
  /// smooth cell tractions is larger by the factor sharpening().
  void inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                       std::span<Symbol> inverses) const override;

  /// The eigenvalues lie within the range of the kernel's symbol on the whole plane of cells. Its least value belongs
  /// to the roughest fields: for square cells without cross contraction 0.2903 h/G where q changes sign from cell to
  /// cell along both axes, 0.3712 times the shorter side over G where cells are oblong. Cross contraction lowers it by
  /// 1 - nu at most, or raises it. Smooth cell tractions raise it, most for the roughest fields.
  double least_eigenvalue(double h1, double h2) const override;

  bool couples() const override { return pair_.mismatch != 0.0; }
  void add_to(CacheKey& key) const override;

 private:
  Tables tables_of_constant(std::span<const Component> components, const Grid& offsets, int threads) const;

  ElasticPair pair_;
  CellTraction cell_traction_;
};

/// The tables of cell tractions. constant(offsets): those of constant ones, which are smoothed from tables of one row
/// and one column more.
Tables tables_of(CellTraction cell_traction, std::span<const Component> components, const Grid& offsets,
                 const std::function<Tables(const Grid&)>& constant);

/// The factor of a symbol by second differences: 1 less the sum of theirs over 24. phase: xi h, of a wave
/// from a cell to the next.
double sharpening(CellTraction cell_traction, double phase1, double phase2);

/// A law to share.
inline SharedLaw half_spaces(const HalfSpace& lower, const HalfSpace& upper) {
  return std::make_shared<HalfSpaces>(elastic_pair(lower, upper));
}

}  // namespace slipstick::solver
