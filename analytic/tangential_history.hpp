#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "analytic/cattaneo_mindlin.hpp"

/// Tangential force on an axisymmetric contact whose normal load changes too (sphere: Mindlin and
/// Deresiewicz 1953; by superposition: Jaeger 1998). Exact as far as cattaneo_mindlin.hpp is.
namespace slipstick::analytic::tangential {

/// Dimensionless with a reference load W_0: loads over W_0, forces over mu W_0, lengths over the contact
/// radius a_0 under W_0, displacement as G_t a_0 delta/(mu W_0), energies over (mu W_0)^2/(G_t a_0).
struct HistoryState {
  double normal_load;        ///< W/W_0
  double force;              ///< F/(mu W_0), signed
  double contact_radius;     ///< a/a_0
  double stick_radius;       ///< front of the newest slip ring, over a_0; the contact radius where none is
  double displacement;       ///< G_t a_0 delta/(mu W_0), signed as F
  double tangent_stiffness;  ///< (dF/ddelta)/(G_t a_0) at constant W on going on; on turning back 4 a/a_0
  double dissipated;         ///< energy lost since the first contact; exact for nu_i = 0 only, as all else
};

/// A contact with its memory of loads. The pressure is a superposition of flat punches, one for each load
/// that the contact has grown through; the traction is the same superposition with every punch's part times
/// mu and a share in [-1, 1]. New punches, as W grows by dW and F by dF, come with the share dF/(mu dW) and
/// no slip where that is at most 1. Otherwise, and always where W does not grow, slip starts at the edge and
/// sets the shares to 1 or -1, from the outermost punch inwards, until their sum balances F; a falling W
/// takes the outermost punches away. At constant W this is Masing's rule.
///
/// Every member of the state, and a traction over p0, has an absolute error of some 1e-15 of the largest so
/// far; for small slip cattaneo_mindlin.hpp has more digits.
class TangentialHistory {
 public:
  /// Out of contact.
  explicit TangentialHistory(SelfSimilarIndenter indenter = SelfSimilarIndenter()) : indenter_(std::move(indenter)) {}

  /// On to W/W_0 and F/(mu W_0) along a straight line in the plane of both. Throws std::domain_error, with
  /// the state unchanged, unless 0 < W and |F| < mu W (beyond is gross slip).
  void load_to(double normal_load, double force);

  HistoryState state() const;
  /// Traction q/(mu p0) along F at radius r/a_0 >= 0, p0 the profile's under W_0; 0 outside the contact.
  /// Throws std::domain_error for r < 0 and where the pressure is infinite.
  double traction(double radius) const;

 private:
  /// The punches from the load of the layer before up to this one's.
  struct Layer {
    double load;
    double share;
  };
  /// How a step slipped: the shares became `direction` for the punches from the outermost to the one of load `front`.
  struct Slip {
    double front;
    double direction;
  };

  /// On a way with falling W the edge may catch up with the front, and slip turns round: the first such ring.
  std::optional<Slip> ring_that_ends_before(double normal_load, double force) const;
  double inner_load(std::size_t layer) const { return layer == 0 ? 0 : layers_[layer - 1].load; }
  double normal_load() const { return layers_.empty() ? 0 : layers_.back().load; }
  /// The integral of the shares over the loads from `low` to `high`.
  double force_between(double low, double high) const;
  void cut_down_to(double normal_load);
  Slip slip_inwards(double missing_force);
  /// By a step to a normal load that slips so, from these layers.
  double energy_lost(const Slip& slip, double normal_load) const;

  SelfSimilarIndenter indenter_;
  std::vector<Layer> layers_;
  double force_ = 0;
  double dissipated_ = 0;
};

}  // namespace slipstick::analytic::tangential
