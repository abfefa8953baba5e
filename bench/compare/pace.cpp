#include "bench/compare/pace.hpp"

#include <algorithm>
#include <limits>

#include "bench/timing/four_transforms.hpp"
#include "bench/timing/side_by_side.hpp"

namespace slipstick::bench {
namespace {

constexpr solver::Index kCells = 128;
/// Long enough for what interrupts a program to show.
constexpr double kSeconds = 0.02;
/// A first look at how quick the machine can be.
constexpr int kFirstLooks = 25;

}  // namespace

double pace_seconds() {
  static FourTransforms<double> transforms(kCells);
  const auto once = [&] { return seconds(transforms); };
  return call_for(kSeconds, once).seconds;
}

Pace::Pace(double reference) : reference_(reference), best_(std::numeric_limits<double>::infinity()) {
  for (int i = 0; i < kFirstLooks; ++i) best_ = std::min(best_, pace_seconds());
}

bool Pace::is_full() {
  const double now = pace_seconds();
  best_ = std::min(best_, now);
  return now <= (1.0 + kSlack) * best_;
}

bool Pace::is_below_reference() const { return reference_ > 0.0 && best_ > (1.0 + kSlack) * reference_; }

}  // namespace slipstick::bench
