#include "convergence/loops/loop_laws.hpp"

#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analytic/approximations.hpp"

namespace slipstick::convergence {
namespace {

using Parameters = std::vector<double>;

/// What a fit varies, and the moments that follow; parameters are positive, varied by their logarithms.
struct Family {
  std::string name;
  Parameters middle;  ///< the fit starts around it
  std::function<std::vector<double>(const LoopPath&, const LoopStart&, const Parameters&)> moment;
  std::function<std::string(const Parameters&)> sentence;
};

/// Parameters in steps of a factor around others, all of them together.
std::vector<Parameters> around(const Parameters& middle) {
  std::vector<Parameters> points{{}};
  for (const double value : middle) {
    std::vector<Parameters> longer;
    for (const Parameters& point : points) {
      for (int step = -3; step <= 3; ++step) {
        longer.push_back(point);
        longer.back().push_back(value * std::exp(0.4 * step));
      }
    }
    points = longer;
  }
  return points;
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return *high - *low;
}

/// Fits families to a loop: their parameters, the record's start, the offset of its moments and, where rows
/// are noisy, the rotations in its turns.
class Fitter {
 public:
  Fitter(const LoopPath& path, double law_error)
      : path_(path), range_(range_of(path.twist)), floor_(law_error * range_of(path.moment)) {
    const double first = path.twist[0];
    constexpr double kAtZero = 0.05;  // of the range
    starts_ = {{}};
    const bool from_rest =
        std::abs(first) <= kAtZero * range_ && std::abs(path.moment[0]) <= kAtZero * range_of(path.moment);
    if (from_rest && path.turns.size() < 3) return;
    const auto [low, high] = std::ranges::minmax_element(path.twist);
    const double sign = path.turn_twist[1] >= path.turn_twist[0] ? 1.0 : -1.0;
    starts_.push_back({-first, 0.0});
    starts_.push_back({-0.5 * (*low + *high), 0.5 * range_});
    // Elsewhere on first loading; at a reversal; on the way back from one.
    for (const double part : {0.25, 0.5, 1.0, 2.0}) {
      starts_.push_back({sign * part * range_ - first, 0.0});
      starts_.push_back({-sign * part * range_ - first, part * range_});
      starts_.push_back({-first, part * range_});
    }
  }

  LoopHypothesis fit(const Family& family) const {
    LoopHypothesis best;
    best.cost = std::numeric_limits<double>::infinity();
    const std::vector<Parameters> grid = around(family.middle);
    const std::size_t starts = grid.size() > 1 ? std::min<std::size_t>(starts_.size(), 3) : starts_.size();
    for (std::size_t k = 0; k < starts; ++k) {
      LoopHypothesis found;
      found.cost = std::numeric_limits<double>::infinity();
      for (const Parameters& parameters : grid) {
        const LoopHypothesis tried = at(family, {path_, starts_[k], parameters}, k > 0);
        if (tried.cost < found.cost) found = tried;
      }
      if (!(found.cost < std::numeric_limits<double>::infinity())) continue;
      found = polish(family, found, k > 0);
      if (found.cost < best.cost) best = found;
    }
    best.name = family.name;
    best.sentence = family.sentence(best.parameters);
    return best;
  }

 private:
  struct State {
    LoopPath path;
    LoopStart start;
    Parameters parameters;
  };

  LoopHypothesis at(const Family& family, const State& state, bool start_is_free) const {
    LoopHypothesis found;
    found.start = state.start;
    found.parameters = state.parameters;
    found.moment = family.moment(state.path, state.start, state.parameters);
    const auto rows = static_cast<double>(path_.moment.size());
    std::vector<double> apart;
    for (std::size_t row = 0; row < path_.moment.size(); ++row) {
      apart.push_back(path_.moment[row] - found.moment[row]);
    }
    std::ranges::sort(apart);  // the mean without 2 % at each end, such as rows at a jump
    const std::size_t cut = apart.size() / 50;
    for (std::size_t k = cut; k < apart.size() - cut; ++k) {
      found.offset += apart[k] / static_cast<double>(apart.size() - 2 * cut);
    }
    std::vector<double> error;
    double largest = 0.0;
    for (std::size_t row = 0; row < path_.moment.size(); ++row) {
      found.moment[row] += found.offset;
      error.push_back(found.moment[row] - path_.moment[row]);
      largest = std::max(largest, std::abs(path_.moment[row] - found.offset));
    }
    const double rms = trimmed_mean(error);
    constexpr double kPrice = 12.0;  // of a parameter, in units of chi squared
    const double parameters = static_cast<double>(state.parameters.size()) + (start_is_free ? 2.0 : 0.0);
    found.residual = rms / largest;
    found.cost = rows * std::log(rms * rms + floor_ * floor_) + kPrice * parameters;
    if (!std::isfinite(found.cost)) found.cost = std::numeric_limits<double>::infinity();
    return found;
  }

  /// The state that a vector of unknowns stands for: logarithms of parameters; the start's two numbers and
  /// the changes of the turns' rotations over the range.
  State state_of(const LoopHypothesis& from, const Eigen::VectorXd& x, bool start_is_free) const {
    State state{path_, from.start, from.parameters};
    Eigen::Index k = 0;
    for (double& value : state.parameters) value *= std::exp(std::clamp(x[k++], -12.0, 12.0));
    if (start_is_free) {
      state.start.shift += range_ * x[k++];
      const double turned = state.start.turned + range_ * x[k++];
      state.start.turned = from.start.turned > 0.0 ? std::abs(turned) : 0.0;
    }
    for (std::size_t turn = 1; k < x.size(); ++turn) state.path.turn_twist[turn] += range_ * x[k++];
    return state;
  }

  /// Levenberg's and Marquardt's method on the rows that are not among the 2 % farthest off.
  LoopHypothesis polish(const Family& family, LoopHypothesis best, bool start_is_free) const {
    constexpr std::size_t kMaxTurns = 24;
    constexpr int kMaxSteps = 30;
    const bool turns_are_free = path_.twist_noise > 1e-4 * range_ && path_.turns.size() <= kMaxTurns;
    const auto turns = static_cast<Eigen::Index>(turns_are_free ? path_.turns.size() - 2 : 0);
    const Eigen::Index fixed = static_cast<Eigen::Index>(best.parameters.size()) + (start_is_free ? 2 : 0);
    const Eigen::Index count = fixed + turns;
    if (count == 0) return best;
    const LoopHypothesis from = best;
    const auto rows = static_cast<Eigen::Index>(path_.moment.size());
    const auto errors = [&](const LoopHypothesis& tried) -> Eigen::VectorXd {
      return Eigen::Map<const Eigen::VectorXd>(tried.moment.data(), rows) -
             Eigen::Map<const Eigen::VectorXd>(path_.moment.data(), rows);
    };
    const auto tried_at = [&](const Eigen::VectorXd& x) {
      return at(family, state_of(from, x, start_is_free), start_is_free);
    };
    Eigen::VectorXd x = Eigen::VectorXd::Zero(count);
    double damping = 1e-3;
    for (int step = 0; step < kMaxSteps && damping < 1e6; ++step) {
      const Eigen::VectorXd error = errors(best);
      std::vector<double> sizes(error.begin(), error.end());
      for (double& size : sizes) size = std::abs(size);
      std::ranges::nth_element(sizes, sizes.begin() + (rows - 1) * 98 / 100);
      const double farthest = sizes[static_cast<std::size_t>((rows - 1) * 98 / 100)];
      const Eigen::ArrayXd counts = (error.array().abs() <= farthest).cast<double>();
      Eigen::MatrixXd slopes(rows, count);
      constexpr double kDifference = 1e-6;
      for (Eigen::Index k = 0; k < count; ++k) {
        Eigen::VectorXd other = x;
        other[k] += kDifference;
        slopes.col(k) = ((errors(tried_at(other)) - error).array() * counts / kDifference).matrix();
      }
      Eigen::MatrixXd square = slopes.transpose() * slopes;
      Eigen::VectorXd right = slopes.transpose() * error;
      // A turn's rotation is known but for its noise.
      const double stiff =
          std::pow(best.residual * 0.5 * range_of(path_.moment) * range_ / path_.twist_noise, 2);
      for (Eigen::Index k = fixed; k < count; ++k) {
        square(k, k) += stiff;
        right[k] += stiff * x[k];
      }
      bool better = false;
      for (; damping < 1e6 && !better; damping *= better ? 0.1 : 10.0) {
        Eigen::MatrixXd damped = square;
        damped.diagonal() += damping * square.diagonal() + Eigen::VectorXd::Constant(count, 1e-300);
        const Eigen::VectorXd next = x - damped.ldlt().solve(right);
        if (!next.allFinite()) continue;
        const LoopHypothesis tried = tried_at(next);
        better = tried.cost < best.cost;
        if (!better) continue;
        const bool settled = best.cost - tried.cost < 1e-3;
        best = tried;
        x = next;
        if (settled) return best;
      }
    }
    return best;
  }

  const LoopPath& path_;
  double range_;
  double floor_;
  std::vector<LoopStart> starts_;
};

/// Moments of a law whose limit and stiffness are scaled, row by row.
std::vector<double> scaled(LoopPath path, LoopStart start, const BranchLaw& law,
                           const std::vector<double>& limit, const std::vector<double>& stiffness) {
  const auto at = [&](std::size_t row, double twist) {
    return (twist + start.shift) * stiffness[row] / limit[row];
  };
  for (std::size_t row = 0; row < path.twist.size(); ++row) path.twist[row] = at(row, path.twist[row]);
  for (std::size_t k = 0; k < path.turns.size(); ++k) {
    path.turn_twist[k] = at(path.turns[k], path.turn_twist[k]);
  }
  std::vector<double> moment = follow(path, {0.0, start.turned * stiffness[0] / limit[0]}, law);
  for (std::size_t row = 0; row < moment.size(); ++row) moment[row] *= limit[row];
  return moment;
}

std::vector<double> scaled(const LoopPath& path, const LoopStart& start, const BranchLaw& law, double limit,
                           double stiffness) {
  const std::size_t rows = path.twist.size();
  return scaled(path, start, law, std::vector<double>(rows, limit), std::vector<double>(rows, stiffness));
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

/// The stiffness at rest, in words; what is wrong with it, unless something else is.
std::string stiffness_text(double stiffness, const LoopContact& contact) {
  constexpr double kSame = 0.03;
  std::string text = stiffness > 0.1 && stiffness < 100.0
                         ? fmt::format("the stiffness at rest is {:.2f} of the exact one", stiffness)
                         : fmt::format("the stiffness at rest is {:.3g} of the exact one", stiffness);
  if (is_near(stiffness, contact.one_body_upper, kSame) ||
      is_near(stiffness, contact.one_body_lower, kSame)) {
    return text + ": the compliance of one body only, the other taken to be rigid";
  }
  if (is_near(stiffness, 0.5, kSame)) text += ": twice the compliance of the pair";
  return text;
}

/// What follows a law's own words: its limit and stiffness, where they are not the exact ones.
std::string beside(double limit, double stiffness, const LoopContact& contact) {
  constexpr double kSame = 0.02;
  return (is_near(limit, 1.0, kSame) ? "" : "; " + slips_at(limit, contact)) +
         (is_near(stiffness, 1.0, kSame) ? "" : "; " + stiffness_text(stiffness, contact));
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

/// Which of limit and stiffness a family varies.
enum class Free { none, limit, stiffness, factor, both };

/// Limit and stiffness that parameters stand for.
std::pair<double, double> limit_and_stiffness(Free free, const Parameters& p) {
  switch (free) {
    case Free::none:
      return {1.0, 1.0};
    case Free::limit:
      return {p[0], 1.0};
    case Free::stiffness:
      return {1.0, p[0]};
    case Free::factor:
      return {p[0], p[0]};
    default:
      return {p[0], p[1]};
  }
}

Parameters middle_of(Free free) {
  return free == Free::none ? Parameters{} : free == Free::both ? Parameters{1.0, 1.0} : Parameters{1.0};
}

/// Makes families of wrong laws.
class Families {
 public:
  Families(const LoopPath& path, const LoopContact& contact) : path_(path), contact_(contact) {
    rate_ = rates(path);
    for (const double r : rate_) fastest_ = std::max(fastest_, std::abs(r));
    add_springs();
    add_rules();
    add_scaled();
    add_curves();
    add_rate_laws();
    add_drift();
  }
  const std::vector<Family>& list() const { return list_; }

 private:
  void add(const char* name, const BranchLaw& law, const std::string& sentence,
           const std::vector<Free>& sets) {
    for (const Free free : sets) {
      list_.push_back({name, middle_of(free),
                       [=, this](const LoopPath& path, const LoopStart& start, const Parameters& p) {
                         const auto [limit, stiffness] = limit_and_stiffness(free, p);
                         const double most =
                             kLargestStiffness * limit / (contact_.stiffness * range_of(path.twist));
                         const bool is_far = !(limit >= 1.0 / kLargestLimit && limit <= kLargestLimit);
                         if (is_far || stiffness > std::max(1.0, most))
                           return std::vector<double>(path.twist.size(), NAN);
                         return scaled(path, start, law, limit, stiffness);
                       },
                       [=, this](const Parameters& p) {
                         const auto [limit, stiffness] = limit_and_stiffness(free, p);
                         return sentence + beside(limit, stiffness, contact_);
                       }});
    }
  }

  void add_springs() {
    const double rest = contact_.stiffness;
    const auto spring = [rest](double t) { return std::clamp(rest * t, -1.0, 1.0); };
    add("elastic", {[rest](double t) { return rest * t; }, BranchRule::elastic},
        "no slip: elastic, no energy is lost", {Free::none, Free::stiffness});
    constexpr double kRigid = 1e5;
    add("rigid", {[spring](double t) { return spring(kRigid * t); }}, "no presliding: the law is rigid",
        {Free::none, Free::limit});
    for (const Free free : {Free::none, Free::limit, Free::stiffness, Free::both}) {
      add("spring_and_cap", {spring}, "", {free});
      list_.back().sentence = [=, this](const Parameters& p) {
        const auto [limit, stiffness] = limit_and_stiffness(free, p);
        return slips_at(limit, contact_) + "; a spring up to there, without partial slip; " +
               (is_near(stiffness, 1.0, 0.02) ? "the stiffness at rest is right"
                                              : stiffness_text(stiffness, contact_));
      };
    }
  }

  void add_rules() {
    const std::vector<Free> sets{Free::none, Free::stiffness, Free::limit};
    add("not_enlarged", {contact_.loading, BranchRule::not_enlarged},
        "unloads along the curve of first loading, not enlarged twice: breaks Masing's rule", sets);
    add("unloads_without_slip", {contact_.loading, BranchRule::no_slip_back, contact_.stiffness},
        "unloads with the stiffness at rest, without slip: breaks Masing's rule", sets);
    add("elastic", {contact_.loading, BranchRule::elastic},
        "unloads along the curve of first loading itself: no energy is lost, breaks Masing's rule", sets);
  }

  void add_scaled() {
    const BranchLaw exact{contact_.loading};
    const auto one = [&](const char* name, Free free, const auto& sentence) {
      add(name, exact, "", {free});
      list_.back().sentence = sentence;
    };
    one("stiffness", Free::stiffness, [&](const Parameters& p) { return stiffness_text(p[0], contact_); });
    one("limit", Free::limit, [&](const Parameters& p) { return slips_at(p[0], contact_); });
    one("factor", Free::factor, [&](const Parameters& p) {
      return fmt::format("all {}s are {:.2f} times the exact ones", contact_.words.load, p[0]) +
             (is_near(p[0], 2.0, 0.02)   ? ": counted twice"
              : is_near(p[0], 0.5, 0.02) ? ": halved"
                                         : "");
    });
    one("limit_and_stiffness", Free::both, [&](const Parameters& p) {
      return slips_at(p[0], contact_) + "; " + stiffness_text(p[1], contact_);
    });
  }

  void add_curves() {
    const std::vector<Free> sets{Free::none, Free::limit, Free::stiffness, Free::both};
    if (contact_.sphere_limit) {
      const double limit = *contact_.sphere_limit;
      add("equation_7", {[limit](double t) { return equation_7_moment(t, limit); }},
          "too stiff near the limit, which it reaches at a finite rotation: the paper's Eq. (7), an "
          "approximation for small moments",
          {Free::none});
    }
    for (const auto& [name, loading] : contact_.other_profiles) {
      add("other_profile", {loading}, "the law of another profile: " + name, {Free::none, Free::limit});
    }
    const double rest = contact_.stiffness;
    add("exponential", {[rest](double t) { return std::copysign(-std::expm1(-rest * std::abs(t)), t); }},
        "an exponential approach to the limit in place of partial slip", sets);
  }

  void add_rate_laws() {
    for (const bool slips : {true, false}) {
      const double rest = contact_.stiffness;
      const BranchLaw law = slips ? BranchLaw{contact_.loading}
                                  : BranchLaw{[rest](double t) { return rest * t; }, BranchRule::elastic};
      list_.push_back({"viscous", slips ? Parameters{0.1} : Parameters{0.1, 1.0},
                       [=, this](const LoopPath& path, const LoopStart& start, const Parameters& p) {
                         std::vector<double> moment = scaled(path, start, law, 1.0, slips ? 1.0 : p[1]);
                         for (std::size_t row = 0; row < moment.size(); ++row) {
                           moment[row] += p[0] * rate_[row] / fastest_ * size_;
                         }
                         return moment;
                       },
                       [=, this](const Parameters& p) {
                         return fmt::format(
                             "a part of the {} is viscous, {:.2g} % of the largest at the fastest{}",
                             contact_.words.load, 100.0 * p[0], slips ? "" : "; no slip beside it");
                       }});
    }
    const double per_second = path_.duration > 0.0 ? contact_.motion_unit / path_.duration : NAN;
    const auto regularised = [&](const std::function<double(double)>& shape, double half) {
      list_.push_back(
          {"regularised",
           {1.0, 0.15},
           [=, this](const LoopPath&, const LoopStart&, const Parameters& p) {
             std::vector<double> moment;
             for (const double r : rate_) moment.push_back(p[0] * shape(r / (p[1] * fastest_)));
             return moment;
           },
           [=, this](const Parameters& p) {
             const double creep = 1e3 * half * p[1] * fastest_ * per_second;
             return fmt::format(
                 "creeps below the limit{}: regularised friction, the {} follows from the rate; {}",
                 std::isnan(creep)
                     ? ""
                     : fmt::format(", at {:.2g} {} under half of it", creep, contact_.words.rate_unit),
                 contact_.words.load, slips_at(p[0], contact_));
           }});
    };
    regularised([](double r) { return std::tanh(r); }, std::atanh(0.5));
    regularised([](double r) { return std::clamp(r, -1.0, 1.0); }, 0.5);
    add_rate_dependent_limit();
  }

  /// The limit at the largest mean rate of a branch, and how many times that it is at a tenth of it.
  void add_rate_dependent_limit() {
    std::vector<double> branch_rate(rate_.size());
    for (std::size_t turn = 0; turn + 1 < path_.turns.size(); ++turn) {
      const std::size_t from = path_.turns[turn];
      const std::size_t to = path_.turns[turn + 1];
      const double mean = std::abs(path_.twist[to] - path_.twist[from]) /
                          std::max(part_of(path_, to) - part_of(path_, from), 1e-12);
      for (std::size_t row = from; row <= to; ++row) branch_rate[row] = mean;
    }
    const auto [slowest, fastest] = std::ranges::minmax_element(branch_rate);
    if (!(*fastest > 1.5 * *slowest)) return;
    const BranchLaw exact{contact_.loading};
    list_.push_back(
        {"rate_dependent_limit",
         {1.0, 1.0},
         [=, largest = *fastest](const LoopPath& path, const LoopStart& start, const Parameters& p) {
           std::vector<double> limit;
           for (const double r : branch_rate) {
             const double decades = std::log10(std::max(r / largest, 1e-6));
             limit.push_back(std::clamp(p[0] * std::pow(p[1], -decades), 0.05, 20.0));
           }
           return scaled(path, start, exact, limit, std::vector<double>(limit.size(), 1.0));
         },
         [this](const Parameters& p) {
           return fmt::format("the limit depends on the rate of {}: {:+.0f} % for ten times the rate",
                              contact_.words.motion, 100.0 * (1.0 / p[1] - 1.0));
         }});
  }

  void add_drift() {
    list_.push_back({"normal_load_drifts",
                     {1.0},
                     [this](const LoopPath& path, const LoopStart& start, const Parameters& p) {
                       std::vector<double> limit;
                       std::vector<double> stiffness;
                       for (std::size_t row = 0; row < path.twist.size(); ++row) {
                         const double load = std::max(0.05, 1.0 + (p[0] - 1.0) * part_of(path, row));
                         limit.push_back(std::pow(load, contact_.limit_exponent));
                         stiffness.push_back(std::pow(load, contact_.stiffness_exponent));
                       }
                       return scaled(path, start, {contact_.loading}, limit, stiffness);
                     },
                     [](const Parameters& p) {
                       return fmt::format("the normal load drifts: by {:+.0f} % over the record",
                                          100.0 * (p[0] - 1.0));
                     }});
  }

  /// Limits over the exact one, beyond which a curve is another law's in disguise.
  static constexpr double kLargestLimit = 30.0;
  /// Limits over the stiffness times the range of rotations: what is stiffer is called rigid.
  static constexpr double kLargestStiffness = 60.0;

  const LoopPath& path_;
  const LoopContact& contact_;
  std::vector<double> rate_;
  double fastest_ = 0.0;
  double size_ = 0.5 * range_of(path_.moment);
  std::vector<Family> list_;
};

}  // namespace

LoopHypothesis fit_exact_law(const LoopPath& path, const LoopContact& contact) {
  const BranchLaw exact{contact.loading};
  return Fitter(path, contact.law_error)
      .fit({"exact",
            {},
            [&](const LoopPath& turned, const LoopStart& start, const Parameters&) {
              return follow(turned, start, exact);
            },
            [](const Parameters&) { return "follows the exact law"; }});
}

std::vector<LoopHypothesis> fit_wrong_laws(const LoopPath& path, const LoopContact& contact) {
  const Fitter fitter(path, contact.law_error);
  const Families families(path, contact);
  std::vector<LoopHypothesis> fitted;
  for (const Family& family : families.list()) fitted.push_back(fitter.fit(family));
  return fitted;
}

}  // namespace slipstick::convergence
