#pragma once

#include "solver/model/make_model.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::solver {

/// The normal contact of a scene.
struct Contact {
  Model model;
  NormalSolution solution;
};

inline Contact press(const Scene& scene) {
  Contact contact{make_model(scene), {}};
  contact.solution = find_pressure(scene, contact.model, scene.steps[0]);
  return contact;
}

inline double load(const Contact& contact) {
  return contact.solution.pressure.sum() * contact.model.grid.cell_area() * contact.model.force_unit();
}

}  // namespace slipstick::solver
