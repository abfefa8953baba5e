#pragma once

#include <Eigen/Core>
#include <array>

#include "convergence/check/given_contact.hpp"
#include "solver/certificate.hpp"

namespace slipstick::convergence {

/// What a right answer looks like on a given contact's grid, with its pressure and loads: what this project
/// finds there, and how far from that one may be for the mesh alone. The latter is measured with the right
/// answer on a mesh twice as fine under the same pressure, averaged over the cells: it keeps Coulomb's bound
/// and carries the loads, but knows more than this mesh does.
struct Yardstick {
  Eigen::ArrayXd traction;               ///< 2*cells
  double twist = 0.0;                    ///< rad
  std::array<double, 2> displacement{};  ///< about the scene's origin
  double mesh_error = 0.0;               ///< of tractions: that mean's distance from `traction`, relative, L1
  double gap = 0.0;                      ///< its gap / energy
  solver::SlipDirection direction{};     ///< its slip directions
  /// The field's loads are beyond what friction can carry with its pressure: these are scaled down to
  /// kScaledLoads of the limit.
  bool scaled = false;
};
inline constexpr double kScaledLoads = 0.9;

/// Throws std::runtime_error where a solve does not converge.
Yardstick find_yardstick(const GivenContact& contact);

/// sum |q - r| / sum |r|.
double relative_distance(const Eigen::ArrayXd& traction, const Eigen::ArrayXd& reference);

}  // namespace slipstick::convergence
