#pragma once

#include <memory>

#include "solver/contact/certificate.hpp"
#include "solver/contact/paper_method.hpp"
#include "solver/model/make_model.hpp"
#include "solver/step/pressure.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {

/// Sums of some thousands of numbers round by less.
inline constexpr double kRounding = 1e-12;
/// Stops the iteration where only rounding is left.
inline constexpr double kTight = 1e-11;

inline TangentialProblem under_moment(const Eigen::ArrayXd& bound, double moment) {
  return {.friction_bound = bound, .moment = moment};
}

inline TangentialProblem under_twist(const Eigen::ArrayXd& bound, double twist) {
  return {.friction_bound = bound, .twist = twist};
}

/// The sphere's friction bounds on a grid, to pose problems that a scene cannot.
struct Bench {
  explicit Bench(Index cells, double friction = paper::kFriction, OperatorKind kind = OperatorKind::dcfft) {
    const Scene scene = paper_scene(cells, 0.0);
    model = make_model(scene);
    bound = friction * find_pressure(scene, model, scene.steps[0]).pressure;
    op = make_operator(kind, model.grid, tangential_kernel(), *model.law);
    limit = moment_limit(model.grid, bound);
  }
  TangentialSolution twist_by_moment(double moment_ratio, double tolerance = kTight) const {
    return solve_by_paper_method(*op, under_moment(bound, moment_ratio * limit), {.tolerance = tolerance});
  }
  Certificate certify_solution(const TangentialSolution& solution, double moment) const {
    return certify({solution.traction, solution.elastic_displacement, solution.slip}, bound, rotation_field(model.grid),
                   moment);
  }
  double moment_of(const Eigen::ArrayXd& traction) const { return (traction * rotation_field(model.grid)).sum(); }

  Model model;
  Eigen::ArrayXd bound;
  std::unique_ptr<LinearOperator> op;
  double limit = 0.0;
};

}  // namespace slipstick::solver
