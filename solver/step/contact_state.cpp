#include "solver/step/contact_state.hpp"

#include <algorithm>
#include <cmath>

namespace slipstick::solver {

StepEnd end_of(const Solution& solution) {
  return {.twist = solution.twist_angle,
          .displacement = solution.displacement,
          .moment = solution.moment,
          .force = solution.force,
          .moment_limit = solution.moment_limit};
}

Quantities distance(const StepEnd& from, const StepEnd& to) {
  const auto apart = [](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  };
  return {.twist = std::abs(to.twist - from.twist),
          .displacement = apart(from.displacement, to.displacement),
          .moment = std::abs(to.moment - from.moment),
          .force = apart(from.force, to.force)};
}

void OpenHistory::add(const StepEnd& from, const StepEnd& to, const Resolution& step) {
  const Quantities changes = distance(from, to);
  const Quantities sizes = distance({}, to);
  const bool goes_on = (to.twist - from.twist) * last_twist > 0.0;
  for (const auto number : kQuantities) {
    if (changes.*number > 0.0) sum.*number += step.step * changes.*number;  // 0 of an infinite error is 0
    largest.*number = std::max(largest.*number, sizes.*number);
    const double open = step.open.*number;
    const double known = goes_on ? last_small_stick.*number : 0.0;
    if (open > known) small_stick.*number += open - known;
    largest_small_stick.*number = std::max(largest_small_stick.*number, open);
  }
  worst = std::max(worst, step.step);
  last_small_stick = step.open;
  last_twist = to.twist - from.twist;
}

Quantities OpenHistory::mesh() const {
  constexpr double kLoops = 2.0;  // a loop goes from its largest size to the opposite one
  // A radius that is off by 1 % moves a twist by 3 % and a translation by 1 %.
  constexpr double kOfTranslation = 0.4;
  Quantities open;
  for (const auto number : kQuantities) {
    const bool turns = number == &Quantities::twist || number == &Quantities::moment;
    open.*number = (turns ? 1.0 : kOfTranslation) * std::min(sum.*number, kLoops * worst * largest.*number) +
                   std::min(small_stick.*number, kLoops * largest_small_stick.*number);
  }
  return open;
}

}  // namespace slipstick::solver
