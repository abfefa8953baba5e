#pragma once

#include <utility>
#include <vector>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/law/elastic_law.hpp"

namespace slipstick::solver {

/// A law whose lengths are counted in another unit: a displacement by a unit traction is a length times a
/// compliance, for every law. Laws with a length of their own, a layer's thickness, keep it.
class RescaledLaw final : public ElasticLaw {
 public:
  /// ratio: the new unit of length over that of `law`.
  RescaledLaw(SharedLaw law, double ratio) : law_(std::move(law)), ratio_(ratio) {}

  Tables influence_tables(std::span<const Component> components, const Grid& offsets, int threads = 1) const override {
    Grid there = offsets;
    there.h1 *= ratio_;
    there.h2 *= ratio_;
    auto tables = law_->influence_tables(components, there, threads);
    for (std::vector<double>& table : tables) {
      for (double& displacement : table) displacement /= ratio_;
    }
    return tables;
  }

  void inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                       std::span<Symbol> inverses) const override {
    std::vector<PlaneWave> there(waves.begin(), waves.end());
    for (auto& [xi1, xi2, length] : there) xi1 /= ratio_, xi2 /= ratio_, length /= ratio_;
    law_->inverse_symbols(tangential, ratio_ * h1, ratio_ * h2, there, inverses);
    for (Symbol& inverse : inverses) {
      for (double& entry : inverse) entry *= ratio_;
    }
  }

  double least_eigenvalue(double h1, double h2) const override {
    return law_->least_eigenvalue(ratio_ * h1, ratio_ * h2) / ratio_;
  }
  bool couples() const override { return law_->couples(); }
  void add_to(CacheKey& key) const override {
    law_->add_to(key);
    key.add(ratio_);
  }

 private:
  SharedLaw law_;
  double ratio_;
};

}  // namespace slipstick::solver
