#include "convergence/solve/continuum.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "convergence/results/make_record.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"
#include "solver/step/continuum_gap.hpp"

namespace slipstick::convergence {
namespace {

using solver::ContinuumGap;
using solver::Quantities;
using solver::Scene;
using solver::Solution;

/// A load or motion that the scene imposes, and the number that it leaves open, which is the derivative of a
/// potential V by it. V is the least energy, less the work of imposed motions; if the load is a motion
/// itself, the negative of that. V is convex.
class Imposed {
 public:
  Imposed(const Scene& scene, const Solution& solution)
      : scene_(scene),
        open_(solution.resolution.number),
        turns_(open_ == &Quantities::twist || open_ == &Quantities::moment),
        motion_(open_ == &Quantities::moment || open_ == &Quantities::force) {
    const auto& along = motion_ ? solution.displacement : solution.force;
    length_ = std::hypot(along[0], along[1]);
    direction_ = {along[0] / length_, along[1] / length_};
    if (turns_) length_ = motion_ ? solution.twist_angle : solution.moment;
    if (turns_ && !motion_) scene_.steps.front().torsion = solver::Moment{length_};
  }

  double value() const { return length_; }

  /// The scene with another value.
  Scene at(double value) const {
    Scene scene = scene_;
    solver::Step& step = scene.steps.front();
    const std::array<double, 2> along{value * direction_[0], value * direction_[1]};
    if (turns_ && motion_)
      step.torsion = solver::Twist{value};
    else if (turns_)
      step.torsion = solver::Moment{value};
    else if (motion_)
      step.displacement = along;
    else
      step.force = along;
    return scene;
  }

  double number(const Solution& solution) const {
    if (turns_) return motion_ ? solution.moment : solution.twist_angle;
    const auto& vector = motion_ ? solution.force : solution.displacement;
    return vector[0] * direction_[0] + vector[1] * direction_[1];
  }

  /// V lies between these, J.
  std::pair<double, double> potential(const Solution& solution, const ContinuumGap& found) const {
    const auto& [gap, energy, quadrature_error, density] = found;
    double work = 0.0;
    if (turns_ && motion_) work += solution.twist_angle * solution.moment;
    if (scene_.steps.front().displacement)
      work += solution.displacement[0] * solution.force[0] + solution.displacement[1] * solution.force[1];
    const double low = energy * (1.0 - gap - quadrature_error) - work;
    const double high = energy * (1.0 + quadrature_error) - work;
    return motion_ ? std::pair(-high, -low) : std::pair(low, high);
  }

 private:
  Scene scene_;
  double Quantities::*open_;
  bool turns_;
  bool motion_;
  double length_;
  std::array<double, 2> direction_;
};

/// Both ends of the interval of the number that is open.
std::pair<Number, Number> interval(const Imposed& imposed, const Solution& solution, const ContinuumGap& found,
                                   const std::shared_ptr<solver::SolveCache>& cache) try {
  const double here = imposed.value();
  const auto [at_low, at_high] = imposed.potential(solution, found);
  // A bound by the potential at another value.
  const auto slope = [&, low = at_low](double distance) -> Number {
    try {
      const Scene there = imposed.at(here + distance);
      const Solution other = solver::solve(there, {.cache = cache});
      const double high = imposed.potential(other, solver::continuum_gap(there, other, cache)).second;
      return number_or((high - low) / distance, "the energy under the other load is not finite");
    } catch (const solver::InputError& refused) {  // gross slip
      return {.why_missing = refused.what()};
    }
  };
  // The best distance is sqrt(2 G/V''); V'' is the change of the number over the change of the value.
  const double open = 2.0 * (at_high - at_low);
  const double number = imposed.number(solution);
  const double first = std::copysign(std::min(std::sqrt(open * here / number), std::abs(here)), here);
  const Solution before = solver::solve(imposed.at(here - first), {.cache = cache});
  const double distance = std::sqrt(open * first / (number - imposed.number(before)));
  return {slope(-distance), slope(distance)};
} catch (const solver::InputError& refused) {
  const Number missing{.why_missing = refused.what()};
  return {missing, missing};
}

/// Fills the numbers of the pressure; missing ones have the reason.
void add_pressure(ContinuumRecord& record, const Scene& scene, const Solution& solution) {
  const std::string broken = "the fields are not finite";
  try {
    const solver::PressureGap found = solver::pressure_gap(scene, solution);
    record.pressure_gap = number_or(found.gap, broken);
    record.pressure_energy = number_or(found.energy, broken);
    record.pressure_quadrature_error = number_or(found.quadrature_error, broken);
    record.friction_bound_error =
        number_or(solver::friction_bound_error(scene, solution, found) / record.energy, broken);
  } catch (const std::invalid_argument& refused) {
    for (Number* const number : {&record.pressure_gap, &record.pressure_energy, &record.pressure_quadrature_error,
                                 &record.friction_bound_error}) {
      if (std::isnan(*number)) number->why_missing = refused.what();
    }
  }
}

}  // namespace

ContinuumRecord continuum_record(const Scene& scene, const Solution& solution, Eigen::ArrayXd* density) try {
  const auto cache = std::make_shared<solver::SolveCache>();
  ContinuumGap found = solver::continuum_gap(scene, solution, cache);
  if (density != nullptr) *density = std::move(found.density);
  const std::string broken = "the fields are not finite";
  ContinuumRecord record{.gap = number_or(found.gap, broken),
                         .energy = number_or(found.energy, broken),
                         .quadrature_error = number_or(found.quadrature_error, broken),
                         .number = quantity_key(solution.resolution.number)};
  add_pressure(record, scene, solution);
  const Imposed imposed(scene, solution);
  record.low = record.high = {.why_missing = "only for a load or motion that is not zero"};
  if (!std::isfinite(found.gap) || imposed.value() == 0.0) return record;
  std::tie(record.low, record.high) = interval(imposed, solution, found, cache);
  return record;
} catch (const std::invalid_argument& refused) {
  const Number missing{.why_missing = refused.what()};
  return {missing, missing, missing, "", missing, missing, missing, missing, missing, missing};
}

ProvenAnswer solve_until_proven(Scene scene, double width, const std::function<SolvedScene(const Scene&)>& solve) {
  constexpr int kMaxAttempts = 6;
  constexpr double kMargin = 1.2;  // the width falls with the cells' size, or a little faster
  ProvenAnswer answer{scene, {}, {{"wanted", width}, {"attempts", Json::array()}}, ""};
  std::string not_reached = fmt::format("the interval is too wide after {} meshes", kMaxAttempts);
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    try {
      SolvedScene solved = solve(scene);
      solved.record.end.certificate.continuum = continuum_record(scene, solved.solution, &solved.solution.gap_density);
      answer.solved = std::move(solved);
      answer.scene = scene;
    } catch (const solver::InputError& refused) {
      if (attempt == 0) throw;
      not_reached = refused.what();
      break;
    }
    const ContinuumRecord& found = *answer.solved.record.end.certificate.continuum;
    const std::string why = found.low.why_missing + found.high.why_missing;
    const Number reached = number_or((found.high - found.low) / (0.5 * std::abs(found.high + found.low)), why);
    Json made{{"cells", scene.grid.cells}};
    set_number(made, "width", reached);
    answer.account["attempts"].push_back(std::move(made));
    answer.text += text_line(
        "proven", fmt::format("{} x {} cells: {}", scene.grid.cells[0], scene.grid.cells[1],
                              std::isnan(reached) ? "no interval" : "an interval of " + percent_text(reached)));
    if (reached <= width) return answer;
    if (!answer.solved.record.is_converged() || std::isnan(found.gap)) {
      not_reached = std::isnan(found.gap) ? found.gap.why_missing : "the solve did not converge";
      break;
    }
    // Where the other loads slip, they may do so on this mesh only.
    const double finer = std::isnan(reached) ? 2.0 : std::clamp(kMargin * reached / width, 1.25, 4.0);
    for (solver::Index& cells : scene.grid.cells)
      cells = 2 * static_cast<solver::Index>(std::ceil(0.5 * finer * static_cast<double>(cells)));
  }
  answer.account["not_reached"] = not_reached;
  answer.text += text_line("not reached", not_reached);
  return answer;
}

}  // namespace slipstick::convergence
