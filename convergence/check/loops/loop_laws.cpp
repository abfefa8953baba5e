#include "convergence/check/loops/loop_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace slipstick::convergence {
namespace {

using Parameters = LoopParameters;

/// Relative difference within which a limit or a stiffness is the exact one, or a named one.
constexpr double kSameFactor = 0.02;
/// The same for the stiffness of a wrong compliance.
constexpr double kSameStiffness = 0.03;

/// Moments of a law with limit and stiffness scaled by other factors in each row.
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

/// Values at times that are earlier by a delay; before the first time the first value.
std::vector<double> late(const std::vector<double>& time, const std::vector<double>& values, double delay) {
  std::vector<double> found;
  std::size_t next = 0;
  for (const double now : time) {
    while (next < time.size() && time[next] <= now - delay) ++next;
    if (next == 0) {
      found.push_back(values[0]);
    } else if (next == time.size()) {
      found.push_back(values.back());
    } else {
      const double part = (now - delay - time[next - 1]) / (time[next] - time[next - 1]);
      found.push_back(std::lerp(values[next - 1], values[next], part));
    }
  }
  return found;
}

bool is_near(double value, double wanted, double within) { return std::abs(value / wanted - 1.0) <= within; }

/// Whether a stiffness over the exact one shows another unit, not another law.
bool is_far(double stiffness) { return !(stiffness > 0.1 && stiffness < 10.0); }

/// Words for a limit over the exact one.
std::string slips_at(double limit, const LoopContact& contact) {
  const auto& uniform = contact.uniform_pressure_limit;
  if (is_near(limit, 1.0, kSameFactor)) return "slips at the limit";
  return fmt::format("slips at {:.2f} of the limit{}", limit,
                     uniform && is_near(limit, *uniform, kSameFactor) ? ": uniform pressure assumed" : "");
}

/// Words for a stiffness at rest over the exact one.
std::string stiffness_text(double stiffness, const LoopContact& contact) {
  if (is_far(stiffness)) {
    return fmt::format("the stiffness at rest is {:.3g} of the exact one, as in another unit", stiffness);
  }
  std::string text = fmt::format("the stiffness at rest is {:.2f} of the exact one", stiffness);
  if (is_near(stiffness, contact.one_body_upper, kSameStiffness) ||
      is_near(stiffness, contact.one_body_lower, kSameStiffness)) {
    return text + ": the compliance of one body only, the other taken to be rigid";
  }
  if (is_near(stiffness, 0.5, kSameStiffness)) text += ": twice the compliance of the pair";
  return text;
}

/// Words for limit and stiffness, where they are not the exact ones; they follow the law's own words.
std::string beside(double limit, double stiffness, const LoopContact& contact) {
  return (is_near(limit, 1.0, kSameFactor) ? "" : "; " + slips_at(limit, contact)) +
         (is_near(stiffness, 1.0, kSameFactor) ? "" : "; " + stiffness_text(stiffness, contact));
}

/// Moment of the paper's Eq. (7) at t; beyond its largest t the limit.
double equation_7_moment(double twist, double moment_limit) {
  const double root = std::max(0.0, 2.0 - std::sqrt(1.0 + 8.0 * std::abs(twist)));  // sqrt(1 - 3 M/2)
  return std::copysign(std::min(1.0, 2.0 / 3.0 * (1.0 - root * root) / moment_limit), twist);
}

/// The factors of limit and stiffness that a family varies.
enum class Free { none, limit, stiffness, factor, both };

/// The factors of limit and stiffness for these parameters.
std::pair<double, double> limit_and_stiffness(Free free, const Parameters& p) {
  if (free == Free::none) return {1.0, 1.0};
  if (free == Free::limit) return {p[0], 1.0};
  if (free == Free::stiffness) return {1.0, p[0]};
  return {p[0], free == Free::factor ? p[0] : p[1]};
}

/// The parameters at which a fit starts. stiffness: the record's mean stiffness over the exact one.
Parameters middle_of(Free free, double stiffness) {
  Parameters middle(free == Free::none ? 0 : free == Free::both ? 2 : 1, 1.0);
  if ((free == Free::stiffness || free == Free::both) && is_far(stiffness)) middle.back() = stiffness;
  return middle;
}

/// Makes families of wrong laws.
class Families {
 public:
  Families(const LoopPath& path, const LoopContact& contact) : path_(path), contact_(contact) {
    rate_ = rates(path);
    for (const double r : rate_) fastest_ = std::max(fastest_, std::abs(r));
    add_springs();
    add_bilinear();
    add_scaled();  // before rules: from a reversal on, twice the limit without enlarging is the same law
    add_rules();
    add_curves();
    add_forgetful();
    add_rate_laws();
    add_delay();
    add_drift();
  }
  const std::vector<LoopFamily>& list() const { return list_; }

 private:
  void add(const char* name, const BranchLaw& law, const std::string& sentence,
           const std::vector<Free>& sets) {
    const bool slips = std::string(name) == "other_profile" || std::string(name) == "spring_and_cap";
    for (const Free free : sets) {
      list_.push_back(
          {name, middle_of(free, stiffness_),
           [=, this](const LoopPath& path, const LoopStart& start, const Parameters& p) {
             const auto [limit, stiffness] = limit_and_stiffness(free, p);
             const double most = kLargestStiffness * limit / (contact_.stiffness * range_of(path.twist));
             const bool is_other = !(limit >= 1.0 / kLargestLimit && limit <= kLargestLimit);
             const bool is_rigid = law.rule != BranchRule::elastic && stiffness > std::max(1.0, most);
             std::vector<double> moment = scaled(path, start, law, limit, stiffness);
             if (is_other || is_rigid ||
                 (slips && std::abs(line_through(path.twist, moment).correlation) >= of_a_line_)) {
               moment.assign(moment.size(), NAN);
             }
             return moment;
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
               (is_near(stiffness, 1.0, kSameFactor) ? "the stiffness at rest is right"
                                                     : stiffness_text(stiffness, contact_));
      };
    }
  }

  /// One element of Iwan's that slips, and a spring next to it.
  void add_bilinear() {
    const double rest = contact_.stiffness;
    std::vector<double> spring = path_.twist;
    for (double& value : spring) value *= rest;
    const BranchLaw clipped{[rest](double t) { return std::clamp(rest * t, -1.0, 1.0); }};
    list_.push_back(
        {"bilinear",
         {1.0, 1.0},
         [=](const LoopPath& path, const LoopStart& start, const Parameters& p) {
           return scaled(path, start, clipped, p[0], p[1]);
         },
         [=, this](const Parameters& p) {
           return fmt::format(
               "two springs: one slips at {:.2f} of the limit, and {:.2f} of the exact stiffness stay", p[1],
               p[0]);
         },
         spring});
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
             (is_near(p[0], 2.0, kSameFactor)   ? ": counted twice"
              : is_near(p[0], 0.5, kSameFactor) ? ": halved"
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
        "an exponential approach to the limit instead of partial slip", sets);
    add("hyperbola", {[rest](double t) { return rest * t / (1.0 + rest * std::abs(t)); }},
        "a hyperbola towards the limit instead of partial slip", sets);
  }

  /// Laws of control and of structures: the stiffness follows from the moment in the direction of motion, and
  /// reversals leave no memory.
  void add_forgetful() {
    const double rest = contact_.stiffness;
    const auto by_moment = [&](const char* name, const char* sentence, const auto& curve,
                               const auto& inverse) {
      add(name,
          {[=](double t) { return curve(rest * t); }, BranchRule::by_moment, rest,
           [=](double m) { return inverse(std::min(m, 1.0 - 1e-12)) / rest; }},
          sentence, {Free::none, Free::both});
    };
    by_moment(
        "dahl", "Dahl's law, without memory of reversals", [](double u) { return -std::expm1(-u); },
        [](double m) { return -std::log1p(-m); });
    by_moment(
        "dahl", "Dahl's law with the exponent 2, without memory of reversals",
        [](double u) { return u / (1.0 + u); }, [](double m) { return m / (1.0 - m); });
    by_moment(
        "dahl", "Dahl's law with the exponent 1/2, without memory of reversals",
        [](double u) { return u < 2.0 ? u - 0.25 * u * u : 1.0; },
        [](double m) { return 2.0 - 2.0 * std::sqrt(1.0 - m); });
    by_moment(
        "bouc_wen", "Bouc's and Wen's law with the exponent 2, without memory of reversals",
        [](double u) { return u < 0.0 ? u : std::tanh(u); },
        [](double m) { return m < 0.0 ? m : std::atanh(m); });
  }

  void add_rate_laws() {
    const double rest = contact_.stiffness;
    const BranchLaw line{[rest](double t) { return rest * t; }, BranchRule::elastic};
    std::vector<double> viscous = rate_;  // of half the range of moments at the fastest
    for (double& r : viscous) r *= 0.5 * range_of(path_.moment) / fastest_;
    for (const bool slips : {true, false}) {
      const BranchLaw law = slips ? BranchLaw{contact_.loading} : line;
      list_.push_back({"viscous", slips ? Parameters{} : Parameters{1.0},
                       [=](const LoopPath& path, const LoopStart& start, const Parameters& p) {
                         return scaled(path, start, law, 1.0, slips ? 1.0 : p[0]);
                       },
                       [=, this](const Parameters& p) {
                         return fmt::format(
                             "a part of the {} is viscous, {:.2g} % of the largest at the fastest{}",
                             contact_.words.load, 100.0 * p[0], slips ? "" : "; nothing slips");
                       },
                       viscous});
    }
    const double per_second = path_.duration > 0.0 ? contact_.motion_unit / path_.duration : NAN;
    const auto regularised = [&](const std::function<double(double)>& shape, double half) {
      list_.push_back(
          {"regularised",
           {1.0, 0.15},
           [=, this](const LoopPath&, const LoopStart&, const Parameters& p) {
             if (p[1] < kSlowest) return std::vector<double>(rate_.size(), NAN);
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
    list_.push_back({"stribeck",
                     {1.0, 0.5, 0.2},
                     [=, this](const LoopPath&, const LoopStart&, const Parameters& p) {
                       constexpr double kBegins = 0.25;  // of the velocity at which friction has fallen
                       std::vector<double> moment;
                       for (const double r : rate_) {
                         const double x = r / (p[2] * fastest_);
                         moment.push_back(p[0] * std::tanh(x / kBegins) * (1.0 + p[1] * std::exp(-x * x)));
                       }
                       return moment;
                     },
                     [=, this](const Parameters& p) {
                       return fmt::format(
                           "friction falls with the rate, Stribeck's law: from {:.2f} of the limit to {:.2f}",
                           p[0] * (1.0 + p[1]), p[0]);
                     }});
  }

  void add_delay() {
    const double branch = 1.0 / static_cast<double>(path_.turns.size() - 1);
    list_.push_back({"delayed",
                     {0.04},
                     [=, this](const LoopPath& path, const LoopStart& start, const Parameters& p) {
                       return late(path.time, follow(path, start, {contact_.loading}), p[0] * branch);
                     },
                     [=, this](const Parameters& p) {
                       const double rows = p[0] * branch * static_cast<double>(path_.time.size() - 1);
                       return fmt::format("the {} comes {:.2g} rows late", contact_.words.load, rows);
                     }});
  }

  void add_drift() {
    list_.push_back({"normal_load_drifts",
                     {1.0},
                     [this](const LoopPath& path, const LoopStart& start, const Parameters& p) {
                       std::vector<double> limit;
                       std::vector<double> stiffness;
                       for (std::size_t row = 0; row < path.twist.size(); ++row) {
                         const double load = std::max(0.05, 1.0 + (p[0] - 1.0) * path.time[row]);
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

  /// Limit over the exact one; at larger ones, and below the inverse, the curve imitates another law.
  static constexpr double kLargestLimit = 30.0;
  /// Rate of creep over the fastest rate; slower creep is a rigid law's.
  static constexpr double kSlowest = 0.03;
  /// Stiffness times the range of rotations over the limit; stiffer laws are called rigid.
  static constexpr double kLargestStiffness = 60.0;

  const LoopPath& path_;
  const LoopContact& contact_;
  double stiffness_ = range_of(path_.moment) / range_of(path_.twist) / contact_.stiffness;
  /// Correlation at which the record's noise hides the difference between a law and a line, as for a flat
  /// punch before it slips: such a law is a spring.
  double of_a_line_ =
      1.0 - 0.5 * std::pow(std::max(1e-4, 2.0 * row_noise(path_, path_.moment) / range_of(path_.moment)), 2);
  std::vector<double> rate_;
  double fastest_ = 0.0;
  std::vector<LoopFamily> list_;
};

}  // namespace

LoopHypothesis fit_exact_law(const LoopPath& path, const LoopContact& contact,
                             const std::vector<LoopStart>& starts) {
  const BranchLaw exact{contact.loading};
  return fit_family(path, contact.law_error, starts,
                    {"exact",
                     {},
                     [&](const LoopPath& turned, const LoopStart& start, const Parameters&) {
                       return follow(turned, start, exact);
                     },
                     [](const Parameters&) { return "follows the exact law"; }});
}

std::vector<LoopHypothesis> fit_wrong_laws(const LoopPath& path, const LoopContact& contact) {
  const Families families(path, contact);
  std::vector<LoopHypothesis> fitted;
  for (const LoopFamily& family : families.list()) {
    fitted.push_back(fit_family(path, contact.law_error, possible_starts(path), family));
  }
  return fitted;
}

}  // namespace slipstick::convergence
