#include "convergence/check/loops/loop_path.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace slipstick::convergence {
namespace {

/// Part of the range of rotations by which a reversal turns back at most before it counts,
constexpr double kReversal = 0.04;
/// and at least;
constexpr double kMinReversal = 1e-3;
/// in between it counts beyond this multiple of the noise's standard deviation.
constexpr double kNoiseSigmas = 8.0;
/// Part of a loop's range within which it has to close.
constexpr double kClosing = 0.02;
/// Part of the range: fourth differences below it belong to a smooth motion, larger ones are noise.
constexpr double kVisibleNoise = 1e-4;

struct Reversal {
  double twist;
  double moment;
};

/// Whether `at` lies beyond `mark` in the direction of `sign`.
bool is_beyond(double at, double mark, double sign) { return sign * (at - mark) >= 0.0; }

/// The number of reversals that still count at a rotation, on a branch in the direction of `sign`. A branch
/// that comes back to the reversal before its own continues the branch before that; beyond the largest
/// rotation it is first loading.
std::size_t remembered(const std::vector<Reversal>& reversals, double twist, double sign) {
  std::size_t count = reversals.size();
  while (count >= 2 && is_beyond(twist, reversals[count - 2].twist, sign)) count -= 2;
  if (count == 1 && is_beyond(twist, -reversals[0].twist, sign)) return 0;
  return count;
}

double moment_at(const std::vector<Reversal>& reversals, std::size_t count, double twist,
                 const BranchLaw& law) {
  if (count == 0 || law.rule == BranchRule::elastic) return law.loading(twist);
  const Reversal& from = reversals[count - 1];
  const double scale = law.rule == BranchRule::masing ? 2.0 : 1.0;
  return from.moment + scale * law.loading((twist - from.twist) / scale);
}

/// Moments of BranchRule::no_slip_back: with the stiffness at rest below the largest moment so far, along
/// first loading beyond it.
std::vector<double> harden(const LoopPath& path, const LoopStart& start, const BranchLaw& law) {
  std::vector<double> moment;
  const double first = path.twist[0] + start.shift;
  double loaded = start.turned > 0.0 ? start.turned : std::abs(first);
  double largest = law.loading(loaded);
  double now = law.loading(first);
  for (std::size_t row = 0; row < path.twist.size(); ++row) {
    if (row > 0) now += law.stiffness * (path.twist[row] - path.twist[row - 1]);
    if (std::abs(now) > largest) {
      loaded += (std::abs(now) - largest) / law.stiffness;
      largest = law.loading(loaded);
      now = std::copysign(largest, now);
    }
    moment.push_back(now);
  }
  return moment;
}

/// Moments of BranchRule::by_moment.
std::vector<double> flow(const LoopPath& path, const LoopStart& start, const BranchLaw& law) {
  std::vector<double> moment(path.twist.size());
  Reversal from{0.0, 0.0};
  const auto at = [&](double twist, double sign) {
    return sign * law.loading(law.inverse(sign * from.moment) + sign * (twist - from.twist));
  };
  const double first = path.turn_twist[1] >= path.turn_twist[0] ? 1.0 : -1.0;
  const double before = -first * start.turned;
  if (start.turned > 0.0) from = {before, at(before, -first)};
  for (std::size_t turn = 0; turn + 1 < path.turns.size(); ++turn) {
    const double sign = path.turn_twist[turn + 1] >= path.turn_twist[turn] ? 1.0 : -1.0;
    for (std::size_t row = path.turns[turn]; row <= path.turns[turn + 1]; ++row) {
      moment[row] = at(path.twist[row] + start.shift, sign);
    }
    const double end = path.turn_twist[turn + 1] + start.shift;
    from = {end, at(end, sign)};
  }
  return moment;
}

/// The rotation at a reversal, from parabolas through some rows before and after it.
double smoothed_turn(const std::vector<double>& twist, std::size_t turn, std::size_t window) {
  const auto end_of = [&](std::size_t from, std::size_t to) {  // of a parabola, at the turn
    const auto rows = static_cast<Eigen::Index>(to - from + 1);
    Eigen::MatrixX3d powers(rows, 3);
    Eigen::VectorXd values(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const std::size_t row = from + static_cast<std::size_t>(i);
      const double x = static_cast<double>(row) - static_cast<double>(turn);
      powers.row(i) << 1.0, x, x * x;
      values[i] = twist[row];
    }
    return Eigen::VectorXd(powers.colPivHouseholderQr().solve(values))[0];
  };
  return 0.5 * (end_of(turn - window, turn) + end_of(turn, turn + window));
}

/// Rows at which the rotation turns back by more than enough, the first and the last.
std::vector<std::size_t> turns_of(const std::vector<double>& twist, double enough) {
  std::vector<std::size_t> turns{0};
  std::size_t extreme = 0;
  double sign = 0.0;
  for (std::size_t row = 1; row < twist.size(); ++row) {
    if (sign == 0.0) {
      if (std::abs(twist[row] - twist[0]) > enough) {
        sign = twist[row] > twist[0] ? 1.0 : -1.0;
        extreme = row;
      }
    } else if (sign * (twist[row] - twist[extreme]) > 0.0) {
      extreme = row;
    } else if (sign * (twist[extreme] - twist[row]) > enough) {
      turns.push_back(extreme);
      extreme = row;
      sign = -sign;
    }
  }
  turns.push_back(twist.size() - 1);
  return turns;
}

}  // namespace

double largest_of(const std::vector<double>& values) {
  double size = 0.0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return *high - *low;
}

LoopLine line_through(std::span<const double> x, std::span<const double> y) {
  const auto centred = [](std::span<const double> values) -> Eigen::VectorXd {
    const Eigen::Map<const Eigen::ArrayXd> map(values.data(), static_cast<Eigen::Index>(values.size()));
    return map - map.mean();
  };
  const Eigen::VectorXd a = centred(x);
  const Eigen::VectorXd b = centred(y);
  return {a.dot(b) / a.squaredNorm(), a.dot(b) / (a.norm() * b.norm())};
}

double trimmed_mean(std::vector<double> values) {
  constexpr double kCounted = 0.98;
  for (double& value : values) value = std::isfinite(value) ? value * value : INFINITY;
  std::ranges::sort(values);
  values.resize(
      std::max<std::size_t>(1, static_cast<std::size_t>(kCounted * static_cast<double>(values.size()))));
  double sum = 0.0;
  for (const double square : values) sum += square;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double row_noise(const LoopPath& path, const std::vector<double>& values) {
  const double size = std::sqrt(70.0);  // 1, 4, 6, 4, 1
  std::vector<double> differences;
  for (std::size_t turn = 0; turn + 1 < path.turns.size(); ++turn) {
    for (std::size_t row = path.turns[turn] + 1; row + 5 < path.turns[turn + 1]; ++row) {
      const double* const v = &values[row];
      differences.push_back((v[0] - 4.0 * v[1] + 6.0 * v[2] - 4.0 * v[3] + v[4]) / size);
    }
  }
  return differences.empty() ? 0.0 : trimmed_mean(differences);
}

void find_turns(LoopPath& path) {
  const std::vector<double>& twist = path.twist;
  const double range = range_of(twist);
  path.turns = turns_of(twist, kReversal * range);
  const double clear = kNoiseSigmas * row_noise(path, twist);
  path.turns = turns_of(twist, std::clamp(clear, kMinReversal * range, kReversal * range));
  path.twist_noise = row_noise(path, twist);
  path.turn_twist.clear();
  for (const std::size_t turn : path.turns) path.turn_twist.push_back(twist[turn]);
  if (!(path.twist_noise > kVisibleNoise * range)) return;
  for (std::size_t k = 1; k + 1 < path.turns.size(); ++k) {
    const std::size_t window =
        std::min(path.turns[k] - path.turns[k - 1], path.turns[k + 1] - path.turns[k]) / 8;
    if (window >= 6) path.turn_twist[k] = smoothed_turn(twist, path.turns[k], window);
  }
}

std::vector<double> follow(const LoopPath& path, const LoopStart& start, const BranchLaw& law) {
  if (law.rule == BranchRule::no_slip_back) return harden(path, start, law);
  if (law.rule == BranchRule::by_moment) return flow(path, start, law);
  std::vector<double> moment(path.twist.size());
  std::vector<Reversal> reversals;
  const double first = path.turn_twist[1] >= path.turn_twist[0] ? 1.0 : -1.0;
  if (start.turned > 0.0) reversals.push_back({-first * start.turned, law.loading(-first * start.turned)});
  const bool forgets = law.rule == BranchRule::masing;
  for (std::size_t turn = 0; turn + 1 < path.turns.size(); ++turn) {
    const double sign = path.turn_twist[turn + 1] >= path.turn_twist[turn] ? 1.0 : -1.0;
    const auto count = [&](double twist) {
      return forgets ? remembered(reversals, twist, sign) : reversals.size();
    };
    for (std::size_t row = path.turns[turn]; row <= path.turns[turn + 1]; ++row) {
      const double twist = path.twist[row] + start.shift;
      moment[row] = moment_at(reversals, count(twist), twist, law);
    }
    const double end = path.turn_twist[turn + 1] + start.shift;
    const double moment_there = moment_at(reversals, count(end), end, law);
    reversals.resize(count(end));
    reversals.push_back({end, moment_there});
  }
  return moment;
}

std::vector<double> rates(const LoopPath& path) {
  constexpr std::size_t kNoisyWindow = 4;
  const std::size_t rows = path.twist.size();
  const bool is_noisy = path.twist_noise > kVisibleNoise * range_of(path.twist);
  const std::size_t window = is_noisy ? kNoisyWindow : 1;
  std::vector<double> rate(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t from = row < window ? 0 : row - window;
    const std::size_t to = std::min(rows - 1, row + window);
    const std::size_t count = to - from + 1;
    rate[row] = line_through({&path.time[from], count}, {&path.twist[from], count}).slope;
  }
  return rate;
}

std::vector<double> loop_areas(const LoopPath& path, const std::vector<double>& moment) {
  std::vector<double> areas;
  for (std::size_t turn = 1; turn + 2 < path.turns.size(); ++turn) {
    const std::size_t first = path.turns[turn];
    const std::size_t last = path.turns[turn + 2];
    const double range = std::abs(path.twist[path.turns[turn + 1]] - path.twist[first]);
    if (std::abs(path.twist[last] - path.twist[first]) > kClosing * range) continue;
    double area = 0.0;
    for (std::size_t row = first; row < last; ++row) {
      area += 0.5 * (moment[row] + moment[row + 1]) * (path.twist[row + 1] - path.twist[row]);
    }
    areas.push_back(area);
    ++turn;
  }
  return areas;
}

}  // namespace slipstick::convergence
