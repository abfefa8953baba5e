#include "solver/model/model.hpp"

#include <cstdint>

#include "solver/elasticity/law/rescaled_law.hpp"

namespace slipstick::solver {

Dimensionless Dimensionless::on_grid(const Grid& in_m, const std::array<double, 2>& centre) const {
  Dimensionless there(in_m.h1);
  there.stress_unit = stress_unit;
  there.grid = {in_m.n1, in_m.n2, 1.0, to_dimensionless(in_m.h2, in_m.h1), in_m.quadrant, in_m.ranks};
  there.pair = pair;
  there.law = std::make_shared<RescaledLaw>(law, there.length_unit / length_unit);
  there.friction = resampled(friction, grid_in_m(), in_m, centre);
  there.hertzian = hertzian;
  there.pressure_coupling = pressure_coupling;
  return there;
}

Elasticity elasticity(const Scene& scene, const Model& model, const Reduction& part) {
  return {.law = model.law,
          .kind = scene.solver.op,
          .threads = model.threads,
          .diagonal = part.diagonal() && !part.grid().ranks.several(),
          .at_edge = scene.ends_at_grid_edge,
          .rounding_seed = static_cast<std::uint64_t>(scene.solver.rounding_seed),
          .cache = model.cache};
}

}  // namespace slipstick::solver
