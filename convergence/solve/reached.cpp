#include "convergence/solve/reached.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/limit.hpp"
#include "solver/grid/grid_transfer.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;
using solver::Solution;

/// Safety factors (Roache 1998) of a number from two meshes, and of a norm of differences.
constexpr double kTwoMeshes = 3.0;
constexpr double kOfNorm = 1.25;
/// Order of convergence where theory gives none, as on rough surfaces.
constexpr double kCautiousOrder = 1.0;

double order_of(const AccuracyQuantity& quantity, const Scene& scene) {
  const double order = expected_order(quantity.path, scene).value;
  return std::isfinite(order) ? order : kCautiousOrder;
}

/// The same rectangle with half as many cells along each side.
Scene half_as_fine(const Scene& scene, const solver::Grid& grid) {
  Scene coarse = scene;
  const solver::Grid half = solver::coarser(grid);
  coarse.grid.cells = {half.n1, half.n2};
  coarse.grid.extent = {grid.h1 * static_cast<double>(grid.n1), grid.h2 * static_cast<double>(grid.n2)};
  return coarse;
}

/// The measured error of smooth contacts on such a mesh. Two meshes may agree by chance, since the error of a
/// number changes its sign from mesh to mesh.
double usual_error(const Solution& solution, AccuracyOf of) {
  const double side = std::sqrt(solution.grid.cell_area());
  return error_with(accuracy_data(), of, 2.0 * solution.contact_radius / side);
}

double value_of(const Solution& solution, const std::string& path) {
  if (path == "moment") return solution.moment;
  return path == "stick_radius" ? solution.stick_radius : solution.twist_angle;
}

double number_error(const Solution& fine, const Solution& coarse, const std::string& path, double order) {
  const double value = value_of(fine, path);
  const Limit limit = richardson_limit(
      {{.size = 1.0, .value = value}, {.size = 2.0, .value = value_of(coarse, path)}}, order);
  return std::abs(limit.uncertainty / value);
}

/// Cell by cell over the same rectangle.
double field_error(const Solution& fine, const Solution& coarse, double order) {
  const Eigen::ArrayXd mean = solver::restrict_to(solver::coarser(fine.grid), fine.grid, fine.traction);
  const double apart = (mean - coarse.traction).matrix().norm() / mean.matrix().norm();
  return kOfNorm * apart / (std::exp2(order) - 1.0);
}

}  // namespace

double estimation_safety(AccuracyOf of) { return of == AccuracyOf::traction ? kOfNorm : kTwoMeshes; }

ReachedError reached_error(const Scene& scene, const Solution& solution, const ErrorsRecord& errors,
                           AccuracyOf of) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const AccuracyQuantity quantity = accuracy_quantity(scene, of);
  if (solution.status != solver::Status::converged) return {unknown, "exact", solution.message};
  const double error = std::abs(quantity.error(errors));
  if (std::isfinite(error)) return {error, "exact", "against the exact answer"};
  const Solution coarse = solver::solve(half_as_fine(scene, solution.grid));
  if (coarse.status != solver::Status::converged) {
    return {unknown, "estimated", fmt::format("on half as many cells: {}", coarse.message)};
  }
  const double order = order_of(quantity, scene);
  const double estimate = quantity.is_field() ? field_error(solution, coarse, order)
                                              : number_error(solution, coarse, quantity.path, order);
  if (!std::isfinite(estimate)) return {unknown, "estimated", "the value, or its error, is zero"};
  return {std::max(estimate, usual_error(solution, of)), "estimated",
          fmt::format("from {} x {} cells, order {}", coarse.grid.n1, coarse.grid.n2, order)};
}

}  // namespace slipstick::convergence
