#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solver/elasticity/operator_kind.hpp"
#include "solver/grid/grid.hpp"

/// Influence coefficients: displacement at a cell's centre due to a unit traction on another cell, for
/// half-spaces (Boussinesq, Cerruti; Love 1929; Johnson 1985, section 3.6). They depend on the offset only.
namespace slipstick::solver {

/// Elastic half-space. shear_modulus may be infinite: a rigid body.
struct HalfSpace {
  double shear_modulus;
  double poisson_ratio;
};

/// What a pair of half-spaces looks like from the interface. u is the displacement of the lower surface less
/// that of the upper, q the traction on the lower one, so compliances add in K11, K12, K22, K33 and subtract
/// in K13, K23.
struct ElasticPair {
  double shear_compliance;    ///< 1/G = sum of 1/G_i
  double poisson_compliance;  ///< sum of nu_i/G_i
  double normal_compliance;   ///< sum of (1 - nu_i)/G_i = 2/E*
  double mismatch;            ///< (1 - 2 nu)/G of the lower less that of the upper; 0 for similar materials
  /// What is between the two: how the tractions on the cells are understood, by whatever evaluates them.
  CellTraction cell_traction = CellTraction::constant;

  double effective_modulus() const { return 2.0 / normal_compliance; }
  double shear_modulus() const { return 1.0 / shear_compliance; }
};

ElasticPair elastic_pair(const HalfSpace& lower, const HalfSpace& upper);

/// A number below every eigenvalue of the tangential influence matrix of any set of cells: q.Kq >= it times
/// q.q. The eigenvalues lie within the range of the kernel's symbol on the whole plane of cells, whose least
/// value belongs to the roughest fields: for square cells without cross contraction 0.2903 h/G where q
/// changes sign from cell to cell along both axes, 0.3712 times the shorter side over G where cells are
/// oblong; cross contraction lowers it by 1 - nu at most, or raises it. Smooth cell tractions raise it, most
/// for the roughest fields.
double least_eigenvalue(const ElasticPair& pair, double h1, double h2);

/// Component ij: displacement along i by traction along j (1, 2 tangential, 3 normal; K21 = K12).
enum class Component { k11, k12, k22, k13, k23, k33 };

/// Of a component as a function of the offset.
Parity parity(Component component);

/// Components at all offsets (k1 h1, k2 h2), 0 <= k1 < m1, 0 <= k2 < m2, row by row, a table for each; the
/// other quadrants follow by parity. Displacement per traction: units of length times compliance. One pass
/// over the offsets serves all components, and square cells need only offsets on one side of the diagonal.
///
/// With CellTraction::smooth each coefficient is less by 1/24 of its second differences along both axes:
/// cells of constant traction lose the part (xi_1^2 h1^2 + xi_2^2 h2^2)/24 of a field's component of wave
/// vector xi, and that gives it back, whatever the contact's shape.
std::vector<std::vector<double>> influence_tables(std::span<const Component> components,
                                                  const ElasticPair& pair, double h1, double h2, Index m1,
                                                  Index m2, int threads = 1);

/// The table of one component.
std::vector<double> influence_coefficients(Component component, const ElasticPair& pair, double h1, double h2,
                                           Index m1, Index m2);

}  // namespace slipstick::solver
