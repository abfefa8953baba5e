#include "convergence/loops/loop_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slipstick::convergence {
namespace {

/// A reversal that counts, as a part of the range of rotations.
constexpr double kReversal = 0.04;
/// How well a loop has to close, as a part of its range.
constexpr double kClosing = 0.02;

struct Reversal {
  double twist;
  double moment;
};

/// Whether `at` lies beyond `mark` for one who goes in the direction of `sign`.
bool is_beyond(double at, double mark, double sign) { return sign * (at - mark) >= 0.0; }

/// How many of the reversals still count at a rotation, for a branch that goes in the direction of `sign`.
std::size_t remembered(const std::vector<Reversal>& reversals, double twist, double sign) {
  std::size_t count = reversals.size();
  while (count >= 2 && is_beyond(twist, reversals[count - 2].twist, sign)) count -= 2;
  if (count == 1 && is_beyond(twist, -reversals[0].twist, sign)) return 0;
  return count;
}

double moment_at(const std::vector<Reversal>& reversals, std::size_t count, double twist,
                 const BranchLaw& law) {
  if (count == 0) return law.loading(twist);
  const Reversal& from = reversals[count - 1];
  return from.moment + law.branch(twist - from.twist);
}

}  // namespace

std::vector<std::size_t> find_turns(const std::vector<double>& twist) {
  const auto [low, high] = std::ranges::minmax_element(twist);
  const double enough = kReversal * (*high - *low);
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

BranchLaw masing_law(std::function<double(double)> loading) {
  const auto enlarged = [loading](double twist) { return 2.0 * loading(0.5 * twist); };
  return {std::move(loading), enlarged};
}

std::vector<double> follow(const LoopPath& path, const BranchLaw& law) {
  std::vector<double> moment(path.twist.size());
  std::vector<Reversal> reversals;
  for (std::size_t turn = 0; turn + 1 < path.turns.size(); ++turn) {
    const double end = path.twist[path.turns[turn + 1]];
    const double sign = end >= path.twist[path.turns[turn]] ? 1.0 : -1.0;
    for (std::size_t row = path.turns[turn]; row <= path.turns[turn + 1]; ++row) {
      const double twist = path.twist[row];
      moment[row] = moment_at(reversals, remembered(reversals, twist, sign), twist, law);
    }
    reversals.resize(remembered(reversals, end, sign));
    reversals.push_back({end, moment[path.turns[turn + 1]]});
  }
  return moment;
}

std::vector<double> rates(const LoopPath& path) {
  constexpr std::size_t kHalfWindow = 4;
  const std::size_t rows = path.twist.size();
  const auto time = [&](std::size_t row) {
    return path.time.empty() ? static_cast<double>(row) / static_cast<double>(rows - 1) : path.time[row];
  };
  std::vector<double> rate(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t from = row < kHalfWindow ? 0 : row - kHalfWindow;
    const std::size_t to = std::min(rows - 1, row + kHalfWindow);
    double middle = 0.0;
    for (std::size_t k = from; k <= to; ++k) middle += time(k) / static_cast<double>(to - from + 1);
    double above = 0.0;
    double below = 0.0;
    for (std::size_t k = from; k <= to; ++k) {
      above += (time(k) - middle) * path.twist[k];
      below += (time(k) - middle) * (time(k) - middle);
    }
    rate[row] = above / below;
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
