#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/law/law_kind.hpp"

namespace slipstick::solver {

/// A thin layer between the two sides of another law. It gives way where it is loaded and nowhere else, as
/// Winkler's foundation: u = K q + c q. That holds at the centre of each cell, whatever the traction does
/// between the centres, so constant and smooth cell tractions have the same c.
class WinklerLayer final : public ElasticLaw {
 public:
  /// Compliances: displacement by a unit traction, zero or positive.
  WinklerLayer(SharedLaw bodies, double normal_compliance, double tangential_compliance)
      : bodies_(std::move(bodies)), normal_(normal_compliance), tangential_(tangential_compliance) {}

  Tables influence_tables(std::span<const Component> components, const Grid& offsets, int threads = 1) const override {
    auto tables = bodies_->influence_tables(components, offsets, threads);
    for (std::size_t c = 0; c < components.size(); ++c) tables[c].front() += compliance(components[c]);
    return tables;
  }

  /// With P the inverse for the bodies: (P^-1 + c I)^-1 = (P + c det P I)/(1 + c tr P + c^2 det P).
  void inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                       std::span<Symbol> inverses) const override {
    bodies_->inverse_symbols(tangential, h1, h2, waves, inverses);
    const double c = tangential ? tangential_ : normal_;
    for (auto& [p11, p12, p22] : inverses) {
      const double determinant = p11 * p22 - p12 * p12;
      const double scale = 1.0 + c * (p11 + p22) + c * c * determinant;
      p11 = (p11 + c * determinant) / scale;
      p12 = p12 / scale;
      p22 = tangential ? (p22 + c * determinant) / scale : 0.0;
    }
  }

  double least_eigenvalue(double h1, double h2) const override {
    return bodies_->least_eigenvalue(h1, h2) + tangential_;
  }
  bool couples() const override { return bodies_->couples(); }
  void add_to(CacheKey& key) const override {
    bodies_->add_to(key);
    key.add(normal_).add(tangential_);
  }

  static LawKind kind() {
    return {.word = "winkler",
            .meaning = "a thin layer that gives way where it is loaded and nowhere else",
            .parameters = {{"normal_compliance", "m/Pa", 1, -1, "How far the layer gives way to a pressure."},
                           {"tangential_compliance", "m/Pa", 1, -1, "How far it gives way to a shear traction."}},
            .make = [](const SharedLaw& bodies, std::span<const double> compliances) -> SharedLaw {
              return std::make_shared<WinklerLayer>(bodies, compliances[0], compliances[1]);
            }};
  }

 private:
  double compliance(Component component) const {
    if (component == Component::k33) return normal_;
    return component == Component::k11 || component == Component::k22 ? tangential_ : 0.0;
  }

  SharedLaw bodies_;
  double normal_;
  double tangential_;
};

}  // namespace slipstick::solver
