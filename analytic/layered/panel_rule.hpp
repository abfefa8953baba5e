#pragma once

#include <cmath>
#include <vector>

#include "analytic/gsl.hpp"

namespace slipstick::analytic::layered {

/// Gauss's rule of 20 points on equal panels of [0, 1], for functions analytic up to 2 detail off the real
/// axis. Panels are at most four times the detail, which leaves 2.41^-40 = 5e-16; resolution below 1 takes 18
/// points, which leave 2e-14.
class PanelRule {
 public:
  PanelRule(double detail, double resolution) {
    static const gsl::GaussRule fine(20);
    static const gsl::GaussRule coarse(18);
    const double panels = std::ceil(0.25 / detail);
    for (double panel = 0; panel < panels; ++panel)
      for (const auto& [fraction, weight] : (resolution < 1 ? coarse : fine).nodes())
        nodes_.push_back({(panel + fraction) / panels, weight / panels});
  }

  const std::vector<gsl::GaussRule::Node>& nodes() const { return nodes_; }

  template <class Function>
  double operator()(const Function& f, double length = 1) const {
    double sum = 0;
    for (const auto& [fraction, weight] : nodes_) sum += weight * f(length * fraction);
    return length * sum;
  }

 private:
  std::vector<gsl::GaussRule::Node> nodes_;
};

}  // namespace slipstick::analytic::layered
