#include "convergence/loops/loop_laws.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analytic/approximations.hpp"

namespace slipstick::convergence {
namespace {

/// What a fit varies, and the moments that follow; parameters are positive, varied by their logarithms.
struct Family {
  std::vector<double> start;
  std::function<std::vector<double>(const std::vector<double>&)> moment;
};

/// Parameters in steps of a factor around others, all of them together.
std::vector<std::vector<double>> around(const std::vector<double>& middle) {
  std::vector<std::vector<double>> points{{}};
  for (const double value : middle) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& point : points) {
      for (int step = -3; step <= 3; ++step) {
        longer.push_back(point);
        longer.back().push_back(value * std::exp(0.4 * step));
      }
    }
    points = longer;
  }
  return points;
}

/// The parameters with the least residual: the best of some all around, and from there by steps along each
/// that halve where none helps.
std::pair<std::vector<double>, double> fit(const LoopPath& path, const Family& family) {
  constexpr double kFirstStep = 0.2;
  constexpr double kLastStep = 2e-3;
  constexpr double kFarthest = 1e5;  // from the exact law's
  std::vector<double> best = family.start;
  double least = residual(path, family.moment(best));
  for (const std::vector<double>& start : around(family.start)) {
    const double found = residual(path, family.moment(start));
    if (!(found < least)) continue;
    best = start;
    least = found;
  }
  for (double step = kFirstStep; step > kLastStep && !best.empty();) {
    bool better = false;
    for (std::size_t k = 0; k < best.size(); ++k) {
      for (const double factor : {std::exp(step), std::exp(-step)}) {
        std::vector<double> tried = best;
        tried[k] *= factor;
        if (!(tried[k] >= 1.0 / kFarthest && tried[k] <= kFarthest)) continue;
        const double found = residual(path, family.moment(tried));
        if (!(found < least)) continue;
        best = tried;
        least = found;
        better = true;
      }
    }
    if (!better) step *= 0.5;
  }
  return {best, least};
}

/// Moments of a law whose limit and stiffness are scaled, row by row.
std::vector<double> scaled(const LoopPath& path, const BranchLaw& law, const std::vector<double>& limit,
                           const std::vector<double>& stiffness) {
  LoopPath other = path;
  for (std::size_t row = 0; row < path.twist.size(); ++row) other.twist[row] *= stiffness[row] / limit[row];
  std::vector<double> moment = follow(other, law);
  for (std::size_t row = 0; row < moment.size(); ++row) moment[row] *= limit[row];
  return moment;
}

std::vector<double> scaled(const LoopPath& path, const BranchLaw& law, double limit, double stiffness) {
  const std::size_t rows = path.twist.size();
  return scaled(path, law, std::vector<double>(rows, limit), std::vector<double>(rows, stiffness));
}

/// Of the record, 0 to 1.
double part_of(const LoopPath& path, std::size_t row) {
  return path.time.empty() ? static_cast<double>(row) / static_cast<double>(path.twist.size() - 1)
                           : path.time[row];
}

bool is_near(double value, double wanted, double within) { return std::abs(value / wanted - 1.0) <= within; }

/// m at which a law with this limit slips, in words.
std::string slips_at(double limit, const LoopContact& contact) {
  constexpr double kSame = 0.02;
  const auto& uniform = contact.uniform_pressure_limit;
  if (is_near(limit, 1.0, kSame)) return "slips at the limit";
  return fmt::format("slips at {:.2f} of the limit{}", limit,
                     uniform && is_near(limit, *uniform, kSame) ? ": uniform pressure assumed" : "");
}

std::string stiffness_text(double stiffness, const LoopContact& contact) {
  constexpr double kSame = 0.03;
  if (is_near(stiffness, 1.0, kSame)) return "the stiffness at rest is right";
  std::string text = fmt::format("the stiffness at rest is {:.2f} of the exact one", stiffness);
  if (is_near(stiffness, contact.one_body_upper, kSame) ||
      is_near(stiffness, contact.one_body_lower, kSame)) {
    return text + ": the compliance of one body only, the other taken to be rigid";
  }
  if (is_near(stiffness, 0.5, kSame)) text += ": twice the compliance of the pair";
  return text;
}

/// Moment of Eq. (7) at t, by bisection; the limit from where it reaches it.
double equation_7_moment(double twist, double moment_limit) {
  const auto* const law = analytic::approximations().data();  // the first is Eq. (7)
  double low = 0.0;
  double high = moment_limit;
  if (std::abs(twist) >= law->twist(high)) return std::copysign(1.0, twist);
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (law->twist(middle) < std::abs(twist) ? low : high) = middle;
  }
  return std::copysign(0.5 * (low + high) / moment_limit, twist);
}

/// Collects fitted laws.
class LawList {
 public:
  LawList(const LoopPath& path, const LoopContact& contact) : path_(path), contact_(contact) {}

  using Parameters = std::vector<double>;
  void add(const std::string& name, const Family& family,
           const std::function<std::string(const Parameters&)>& sentence) {
    auto [parameters, residual] = fit(path_, family);
    list_.push_back({name, parameters, residual, sentence(parameters)});
  }

  void add_without_parameters() {
    const auto fixed = [&](const char* name, const BranchLaw& law, const char* sentence) {
      add(name, {{}, [&, law](const Parameters&) { return follow(path_, law); }},
          [&](const Parameters&) { return sentence; });
    };
    const auto& loading = contact_.loading;
    const double stiffness = contact_.stiffness;
    fixed("exact", masing_law(loading), "follows the exact law");
    if (contact_.sphere_limit) {
      const double limit = *contact_.sphere_limit;
      fixed("equation_7", masing_law([limit](double t) { return equation_7_moment(t, limit); }),
            "too stiff near the limit, which it reaches at a finite rotation: the paper's Eq. (7), an "
            "approximation for small moments");
    }
    fixed("not_enlarged", {loading, loading},
          "unloads along the curve of first loading, not enlarged twice: breaks Masing's rule");
    fixed("unloads_without_slip", {loading, [stiffness](double t) { return stiffness * t; }},
          "unloads with the stiffness at rest, without slip: breaks Masing's rule");
    add("elastic",
        {{},
         [&](const Parameters&) {
           std::vector<double> moment;
           for (const double t : path_.twist) moment.push_back(loading(t));
           return moment;
         }},
        [](const Parameters&) {
          return "unloads along the curve of first loading itself: no energy is lost, breaks Masing's rule";
        });
  }

  void add_scaled() {
    const BranchLaw exact = masing_law(contact_.loading);
    add("factor", {{1.0}, [&, exact](const Parameters& p) { return scaled(path_, exact, p[0], p[0]); }},
        [&](const Parameters& p) {
          return fmt::format("all {}s are {:.2f} times the exact ones", contact_.words.load, p[0]) +
                 (is_near(p[0], 2.0, 0.02)   ? ": counted twice"
                  : is_near(p[0], 0.5, 0.02) ? ": halved"
                                             : "");
        });
    add("stiffness", {{1.0}, [&, exact](const Parameters& p) { return scaled(path_, exact, 1.0, p[0]); }},
        [&](const Parameters& p) { return stiffness_text(p[0], contact_); });
    add("limit", {{1.0}, [&, exact](const Parameters& p) { return scaled(path_, exact, p[0], 1.0); }},
        [&](const Parameters& p) { return slips_at(p[0], contact_); });
    add("limit_and_stiffness",
        {{1.0, 1.0}, [&, exact](const Parameters& p) { return scaled(path_, exact, p[0], p[1]); }},
        [&](const Parameters& p) {
          return slips_at(p[0], contact_) + "; " + stiffness_text(p[1], contact_);
        });
  }

  void add_springs() {
    const BranchLaw spring = masing_law([](double t) { return std::clamp(t, -1.0, 1.0); });
    const double rest = contact_.stiffness;
    add("spring_and_cap",
        {{1.0, 0.7},
         [&, spring, rest](const Parameters& p) { return scaled(path_, spring, p[0], p[1] * rest); }},
        [&](const Parameters& p) {
          return slips_at(p[0], contact_) + "; a spring up to there, without partial slip; " +
                 stiffness_text(p[1], contact_);
        });
    add("rigid",
        {{1.0},
         [&, spring, rest](const Parameters& p) {
           constexpr double kRigid = 1e4;
           return scaled(path_, spring, p[0], kRigid * rest);
         }},
        [&](const Parameters& p) { return "no presliding: the law is rigid; " + slips_at(p[0], contact_); });
  }

  void add_changing() {
    const BranchLaw exact = masing_law(contact_.loading);
    const auto& contact = contact_;
    const auto drifting = [&, exact](const Parameters& p) {
      std::vector<double> limit;
      std::vector<double> stiffness;
      for (std::size_t row = 0; row < path_.twist.size(); ++row) {
        const double load = std::max(0.05, 1.0 + (p[0] - 1.0) * part_of(path_, row));
        limit.push_back(std::pow(load, contact.limit_exponent));
        stiffness.push_back(std::pow(load, contact.stiffness_exponent));
      }
      return scaled(path_, exact, limit, stiffness);
    };
    add("normal_load_drifts", {{1.0}, drifting}, [](const Parameters& p) {
      return fmt::format("the normal load drifts: by {:+.0f} % over the record", 100.0 * (p[0] - 1.0));
    });
    if (!path_.time.empty()) add_rate_laws(exact);
  }

  const std::vector<LoopHypothesis>& list() const { return list_; }

 private:
  void add_rate_laws(const BranchLaw& exact) {
    const std::vector<double> rate = rates(path_);
    std::vector<double> branch_rate(rate.size());
    double largest = 0.0;
    for (std::size_t turn = 0; turn + 1 < path_.turns.size(); ++turn) {
      const std::size_t from = path_.turns[turn];
      const std::size_t to = path_.turns[turn + 1];
      const double mean =
          std::abs(path_.twist[to] - path_.twist[from]) / std::max(path_.time[to] - path_.time[from], 1e-12);
      for (std::size_t row = from; row <= to; ++row) branch_rate[row] = mean;
      largest = std::max(largest, mean);
    }
    // The limit at the largest rate, and how many times that it is at a tenth of it.
    add("rate_dependent_limit",
        {{1.0, 1.0},
         [&, exact, branch_rate, largest](const Parameters& p) {
           std::vector<double> limit;
           for (const double r : branch_rate) {
             const double decades = std::log10(std::max(r / largest, 1e-6));
             limit.push_back(std::clamp(p[0] * std::pow(p[1], -decades), 0.05, 20.0));
           }
           return scaled(path_, exact, limit, std::vector<double>(limit.size(), 1.0));
         }},
        [&](const Parameters& p) {
          return fmt::format("the limit depends on the rate of {}: {:+.0f} % for ten times the rate",
                             contact_.words.motion, 100.0 * (1.0 / p[1] - 1.0));
        });
    double fastest = 0.0;
    for (const double r : rate) fastest = std::max(fastest, std::abs(r));
    const double per_second = path_.duration > 0.0 ? contact_.motion_unit / path_.duration : NAN;
    const auto regularised = [&](const std::function<double(double)>& shape, double half) {
      add("regularised",
          {{1.0, 0.15},
           [&, shape, rate, fastest](const Parameters& p) {
             std::vector<double> moment;
             for (const double r : rate) moment.push_back(p[0] * shape(r / (p[1] * fastest)));
             return moment;
           }},
          [=, this](const Parameters& p) {
            return fmt::format(
                "creeps below the limit, at {:.2g} {} under half of it: regularised friction, the "
                "{} follows from the rate; {}",
                1e3 * half * p[1] * fastest * per_second, contact_.words.rate_unit, contact_.words.load,
                slips_at(p[0], contact_));
          });
    };
    regularised([](double r) { return std::tanh(r); }, std::atanh(0.5));
    regularised([](double r) { return std::clamp(r, -1.0, 1.0); }, 0.5);
  }

  const LoopPath& path_;
  const LoopContact& contact_;
  std::vector<LoopHypothesis> list_;
};

}  // namespace

double residual(const LoopPath& path, const std::vector<double>& moment) {
  constexpr double kCounted = 0.98;
  std::vector<double> squares;
  double largest = 0.0;
  for (std::size_t row = 0; row < moment.size(); ++row) {
    const double error = moment[row] - path.moment[row];
    squares.push_back(std::isfinite(error) ? error * error : INFINITY);
    largest = std::max(largest, std::abs(path.moment[row]));
  }
  std::ranges::sort(squares);
  squares.resize(
      std::max<std::size_t>(1, static_cast<std::size_t>(kCounted * static_cast<double>(squares.size()))));
  double sum = 0.0;
  for (const double square : squares) sum += square;
  return std::sqrt(sum / static_cast<double>(squares.size())) / largest;
}

std::vector<LoopHypothesis> fit_loop_laws(const LoopPath& path, const LoopContact& contact) {
  LawList laws(path, contact);
  laws.add_without_parameters();
  laws.add_springs();
  laws.add_scaled();
  laws.add_changing();
  return laws.list();
}

const LoopHypothesis& most_likely(const std::vector<LoopHypothesis>& fitted) {
  constexpr double kNegligible = 3e-3;  // noise and the rows' distance leave as much
  constexpr double kPrice = 0.5;        // that a parameter has to lower the residual by
  const auto cost = [&](const LoopHypothesis& law) {
    return std::max(law.residual, kNegligible) * (1.0 + kPrice * static_cast<double>(law.parameters.size()));
  };
  return *std::ranges::min_element(fitted, {}, cost);
}

}  // namespace slipstick::convergence
