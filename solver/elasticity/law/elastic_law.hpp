#pragma once

#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

class CacheKey;

/// Component ij: displacement along i by traction along j (1, 2 tangential, 3 normal; K21 = K12).
enum class Component { k11, k12, k22, k13, k23, k33 };
inline constexpr std::array kAllComponents{Component::k11, Component::k12, Component::k22,
                                           Component::k13, Component::k23, Component::k33};

/// The parity of a component in each coordinate of the offset.
inline Parity parity(Component component) {
  switch (component) {
    case Component::k12:
      return {-1, -1};
    case Component::k13:
      return {-1, 1};
    case Component::k23:
      return {1, -1};
    case Component::k11:
    case Component::k22:
    case Component::k33:
      return {1, 1};
  }
  throw std::logic_error("unknown component");
}

/// A wave of tractions: its vector, in radians per unit of length, and the vector's length. A wave of
/// vector zero has no direction, and a positive length stands in for its own.
struct PlaneWave {
  double xi1;
  double xi2;
  double length;
};

/// Distinct entries of a symmetric symbol: p11, p12, p22. A normal symbol is p11, and the others are zero.
using Symbol = std::array<double, 3>;

/// A table of influence coefficients for each of some components.
using Tables = std::vector<std::vector<double>>;

/// The elastic law of an interface: the displacement u of the lower surface less the upper one's, by the
/// traction q on the lower one. It is linear, symmetric, positive definite, homogeneous and isotropic. This
/// class is the solver's only access to elasticity.
class ElasticLaw {
 public:
  ElasticLaw() = default;
  ElasticLaw(const ElasticLaw&) = delete;
  ElasticLaw& operator=(const ElasticLaw&) = delete;
  virtual ~ElasticLaw() = default;

  /// The displacement at a cell's centre by a unit traction on another cell, at the offsets (k1 h1, k2 h2),
  /// 0 <= k1 < n1, 0 <= k2 < n2 of a grid, row by row: a table for each component. The other quadrants follow
  /// by parity(). Units of length times compliance. `threads` share the work and change no bit.
  virtual Tables influence_tables(std::span<const Component> components, const Grid& offsets,
                                  int threads = 1) const = 0;

  /// Inverses of the symbol of (K11, K12, K22), or of K33, at some waves on cells of h1 by h2, for a
  /// preconditioner: they may be approximate, but must be symmetric and positive definite.
  virtual void inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                               std::span<Symbol> inverses) const = 0;

  /// A number below every eigenvalue of the tangential influence matrix of any set of cells: q.Kq >= it times
  /// q.q. The certificate bounds the error in energy by it.
  virtual double least_eigenvalue(double h1, double h2) const = 0;

  /// True if K13 and K23 are not zero: pressures move the surfaces sideways, and shear opens them.
  virtual bool couples() const = 0;

  /// Adds the law's kind and parameters.
  virtual void add_to(CacheKey& key) const = 0;

  /// The table of one component.
  std::vector<double> influence_coefficients(Component component, const Grid& offsets) const {
    return influence_tables(std::span(&component, 1), offsets).front();
  }
};

using SharedLaw = std::shared_ptr<const ElasticLaw>;

}  // namespace slipstick::solver
