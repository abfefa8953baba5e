#include "convergence/orders/expected_order.hpp"

#include <cmath>

namespace slipstick::convergence {
namespace {

using solver::PressureModel;
using solver::Shape;

/// How the tractions end at the contact's edge.
enum class Edge { root, jump, singular, rough };

Edge edge_of(const solver::Scene& scene) {
  Edge edge = scene.contact.friction.kind == solver::FrictionKind::tresca ? Edge::jump : Edge::root;
  for (const solver::Surface& surface : scene.surfaces) {
    if (surface.shape == Shape::flat_punch && edge == Edge::root) edge = Edge::singular;
    if (surface.shape == Shape::height_map || surface.shape == Shape::roughness) return Edge::rough;
  }
  return edge;
}

bool is_norm(const std::string& quantity, const std::string& norm) {
  const bool of_field = quantity.starts_with("traction_error") || quantity.starts_with("pressure_error");
  return of_field && quantity.ends_with("." + norm);
}

ExpectedOrder of_field(const std::string& quantity, Edge edge) {
  if (edge == Edge::singular) {
    if (is_norm(quantity, "l1")) {
      return {0.5,
              "near a punch's edge the traction is proportional to d^(-1/2), and the cells at the edge hold "
              "h^(1/2) of it"};
    }
    return {NAN, "a traction like d^(-1/2) at the edge has no finite norm of this kind"};
  }
  if (edge == Edge::jump) {
    if (is_norm(quantity, "l1")) return {1.0, "the traction ends at its full strength in cells that the edge cuts"};
    if (is_norm(quantity, "l2")) return {0.5, "off by the strength itself in the cells that the edge cuts"};
    return {NAN, "the cell that the edge cuts is off by the strength itself on every mesh"};
  }
  if (is_norm(quantity, "l1")) {
    return {1.5, "tractions have square-root edges: off by h^(1/2) in a band of width h, and by h^2 elsewhere"};
  }
  if (is_norm(quantity, "l2")) {
    return {1.0, "off by h^(1/2) in a band of width h along the edges, whose square sums to h^2"};
  }
  return {0.5, "the cell that a square-root edge cuts is off by h^(1/2)"};
}

ExpectedOrder of_number(const std::string& quantity, const solver::Scene& scene) {
  if (quantity.starts_with("stick_radius_counted")) {
    return {1.0, "an edge found by counting whole cells is known to a part of one"};
  }
  if (quantity.starts_with("stick_")) {
    return {1.0,
            "determined from the slip in at most 24 cells next to the edge: for a wider ring its error is a part "
            "of a cell; on coarser meshes the error falls faster"};
  }
  if (edge_of(scene) == Edge::jump) {
    return {1.0, "the strength acts as far as the outermost cells reach, a part of a cell from the true edge"};
  }
  if (edge_of(scene) == Edge::singular) {
    return {1.0, "the singular edge stands where the outermost cells end, a part of a cell from the true one"};
  }
  if (scene.contact.pressure == PressureModel::hertz_averaged) {
    return {2.0, "averaging over cells keeps the load and widens the pressure by h^2/12 in its second moments"};
  }
  if (scene.contact.pressure == PressureModel::hertz) {
    return {2.0, "a pressure sampled at the centres misses loads by h^2, up or down as the edge lies between them"};
  }
  return {2.0,
          "centres are the points where constant cells err by h^2; the edges' h^(1/2) in a band of width h "
          "enters a minimum's value by its square"};
}

}  // namespace

const std::vector<ErrorQuantity>& error_quantities() {
  static const std::vector<ErrorQuantity> quantities{{"twist_error", "twist"},
                                                     {"moment_error", "moment"},
                                                     {"moment_limit_error", "limit moment"},
                                                     {"displacement_error", "displacement"},
                                                     {"stick_radius_error", "stick radius"},
                                                     {"stick_ratio_error", "stick ratio"},
                                                     {"stick_radius_counted_error", "stick radius, counted"},
                                                     {"contact_radius_error", "contact radius"},
                                                     {"peak_pressure_error", "peak pressure"},
                                                     {"dissipated_error", "energy lost"},
                                                     {"traction_error.l1", "traction L1"},
                                                     {"traction_error.l2", "traction L2"},
                                                     {"traction_error.max", "traction max"},
                                                     {"traction_error.averaged.l1", "traction L1, cell averages"},
                                                     {"traction_error.averaged.l2", "traction L2, cell averages"},
                                                     {"pressure_error.l1", "pressure L1"},
                                                     {"pressure_error.l2", "pressure L2"},
                                                     {"stress_error.max", "stresses, 0.4a deep"}};
  return quantities;
}

const std::vector<std::string>& value_quantities() {
  static const std::vector<std::string> paths{"twist_angle",    "moment",         "moment_limit", "stick_radius",
                                              "contact_radius", "elastic_energy", "dissipated"};
  return paths;
}

const std::vector<double>& aligned_edge_powers() {
  // An edge lies as if a part of a cell from where it is: h, h^2. At a corner the traction goes like
  // r^(alpha - 1), and the cells of a width h there hold h^(1 + 2 alpha) of the energy. That alpha is
  // the one of a plate's right corner: Morrison and Lewis, SIAM J. Appl. Math. 31 (1976) 233-250. Shear
  // tractions have another, by Poisson's ratio, which costs digits: their extrapolations agree less.
  constexpr double kCorner = 0.2966;
  static const std::vector<double> powers{1.0, 1.0 + 2.0 * kCorner, 2.0, 2.0 + 2.0 * kCorner};
  return powers;
}

ExpectedOrder expected_order(const std::string& quantity, const solver::Scene& scene) {
  const Edge edge = edge_of(scene);
  if (edge == Edge::rough) return {NAN, "finer meshes see more of a rough surface"};
  for (const char* norm : {"l1", "l2", "max"}) {
    if (is_norm(quantity, norm)) return of_field(quantity, edge);
  }
  return of_number(quantity, scene);
}

}  // namespace slipstick::convergence
