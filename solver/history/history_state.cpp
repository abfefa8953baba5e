#include "solver/history/history_state.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace slipstick::solver {

Quantities distance(const LoadNumbers& from, const LoadNumbers& to) {
  const auto apart = [](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  };
  return {.twist = std::abs(to.twist_angle - from.twist_angle),
          .displacement = apart(from.displacement, to.displacement),
          .moment = std::abs(to.moment - from.moment),
          .force = apart(from.force, to.force)};
}

void OpenHistory::add(const LoadNumbers& from, const LoadNumbers& to, const Resolution& step) {
  const double turned = to.twist_angle - from.twist_angle;
  const Quantities changes = distance(from, to);
  const Quantities sizes = distance({}, to);
  const bool goes_on = turned * last_twist > 0.0;
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
  last_twist = turned;
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

HistoryState restore_state(const HistoryState& kept, const Scene& scene, Index cells) {
  const ContactState& at = kept.contact;
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  if (kept.finished == 0 || kept.finished >= steps || at.normal.pressure.size() != cells ||
      at.traction.size() != 2 * cells || (at.slip.size() != 0 && at.slip.size() != 2 * cells)) {
    throw std::invalid_argument("the state of a history is not one of this scene");
  }
  HistoryState state = kept;
  state.contact.normal_load = step_of(scene, kept.finished - 1).normal;
  return state;
}

}  // namespace slipstick::solver
