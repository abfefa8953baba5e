#include "convergence/check/diagnosis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/contact/certificate.hpp"
#include "solver/contact/fitted_motion.hpp"
#include "solver/elasticity/law/half_spaces.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

/// Pairs of cells in a sum: about a second's work.
constexpr double kMaxPairs = 1e8;
/// An assumption explains a gap if it lowers it to this part.
constexpr double kExplains = 0.1;
/// Gap over energy of the stick area that any iteration may leave: no kernel is sought to explain it.
constexpr double kNoStickGap = 10.0 * kIterationGap;

/// The contact's cells as sources, and those at which displacements are summed.
struct Cells {
  std::vector<Index> sources;
  std::vector<Index> points;
};

Cells choose_cells(const GivenContact& contact) {
  Cells cells;
  for (Index cell = 0; cell < contact.pressure.size(); ++cell) {
    if (contact.pressure[cell] > 0.0) cells.sources.push_back(cell);
  }
  const std::size_t count = cells.sources.size();
  const auto every = static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(count), 2) / kMaxPairs));
  for (std::size_t k = 0; k < count; k += every) cells.points.push_back(cells.sources[k]);
  return cells;
}

/// The values of a field of any number of components at some of its cells.
ArrayXd at(const std::vector<Index>& points, const ArrayXd& field, Index cells) {
  return field.reshaped(cells, field.size() / cells)(points, Eigen::all).reshaped();
}

/// The part of the displacements that cross contraction of the half-spaces makes, over their Poisson
/// compliance: poisson + cross, by K11 and K22 and by K12. `mirrored` has |K12| instead of K12, in
/// `exchanged` K11 and K22 have changed places.
struct Displacements {
  ArrayXd poisson, cross, mirrored, exchanged;
};

Displacements sum_displacements(const GivenContact& contact, const Cells& cells) {
  const solver::Grid& grid = contact.grid;
  const std::array components{solver::Component::k11, solver::Component::k22, solver::Component::k12};
  const solver::HalfSpaces contraction({0.0, 1.0, 0.0, 0.0});
  const auto poisson = contraction.influence_tables(components, grid);
  const auto count = static_cast<Index>(cells.points.size());
  Displacements u;
  for (ArrayXd* part : {&u.poisson, &u.cross, &u.mirrored, &u.exchanged}) part->setZero(2 * count);
  for (Index k = 0; k < count; ++k) {
    const Index point = cells.points[static_cast<std::size_t>(k)];
    const Index i = point / grid.n2;
    const Index j = point % grid.n2;
    for (const Index source : cells.sources) {
      const Index k1 = i - source / grid.n2;
      const Index k2 = j - source % grid.n2;
      const auto offset = static_cast<std::size_t>(std::abs(k1) * grid.n2 + std::abs(k2));
      const double q1 = contact.traction[source];
      const double q2 = contact.traction[source + grid.cells()];
      const double k12 = poisson[2][offset];
      const double signed_k12 = (k1 < 0) == (k2 < 0) ? k12 : -k12;
      u.poisson[k] += poisson[0][offset] * q1;
      u.poisson[k + count] += poisson[1][offset] * q2;
      u.exchanged[k] += poisson[1][offset] * q1;
      u.exchanged[k + count] += poisson[0][offset] * q2;
      u.cross[k] += signed_k12 * q2;
      u.cross[k + count] += signed_k12 * q1;
      u.mirrored[k] += std::abs(k12) * q2;
      u.mirrored[k + count] += std::abs(k12) * q1;
    }
  }
  return u;
}

/// A mistake in a program's law: the factor of each part of Displacements, and of others.
struct Assumption {
  Cause cause;
  double poisson = 1.0;
  double cross = 1.0;
  double mirrored = 0.0;
  double exchanged = 0.0;
  double by_pressure = 1.0;  ///< of the displacement by pressure, K13 and K23
};

/// Evaluates assumptions on the chosen cells.
class Trial {
 public:
  Trial(const GivenContact& contact, const solver::Step& load)
      : cells_(choose_cells(contact)),
        u_(sum_displacements(contact, cells_)),
        pair_(contact.pair),
        coupled_(contact.pressure_coupling && contact.law->couples()) {
    const Index count = contact.pressure.size();
    const auto here = [&](const ArrayXd& field) { return at(cells_.points, field, count); };
    const RigidMotions motions = rigid_motions(contact, known_motion(contact, load, std::nullopt));
    for (const ArrayXd& motion : motions.free) motions_.push_back(here(motion));
    imposed_ = here(motions.imposed);
    elastic_ = here(contact.elastic_displacement);
    by_pressure_ = here(contact.displacement - contact.elastic_displacement);
    traction_ = here(contact.traction);
    bound_ = here(contact.friction_bound);
    stick_ = here(stick_cells(contact));
  }

  bool coupled() const { return coupled_; }

  Hypothesis of(const Assumption& assumption) const { return of(assumption, bound_); }

  /// The right kernel with another friction.
  Hypothesis of(const OtherFriction& friction) const {
    return of(Assumption{.cause = friction.cause}, at(cells_.points, friction.bound, friction.bound.size()));
  }

  Hypothesis of(const Assumption& assumption, const ArrayXd& bound) const {
    const ArrayXd elastic =
        elastic_ +
        pair_.poisson_compliance * ((assumption.poisson - 1.0) * u_.poisson + (assumption.cross - 1.0) * u_.cross +
                                    assumption.mirrored * u_.mirrored + assumption.exchanged * u_.exchanged);
    const solver::FittedMotion fitted = solver::fit_motion(elastic + assumption.by_pressure * by_pressure_ - imposed_,
                                                           traction_, at_least(bound), motions_);
    const double energy = 0.5 * (traction_ * elastic).sum();
    return {assumption.cause, fitted.gap.sum() / energy, (fitted.gap * stick_).sum() / energy,
            fitted.coefficients[fitted.coefficients.size() - 1]};
  }

  /// The kernels K13 and K23 times the factor that fits best.
  std::optional<Assumption> best_coupling() const {
    const double times = best_multiple(by_pressure_);
    if (!is_unnamed(times, 0.05)) return std::nullopt;
    return Assumption{.cause = {fmt::format("the kernels K13 and K23 are multiplied by {:.3g}", times)},
                      .by_pressure = times};
  }

  /// The kernel K12 times the factor that fits best.
  std::optional<Assumption> best_cross() const {
    const double times = best_multiple(pair_.poisson_compliance * u_.cross);
    if (!is_unnamed(times, 0.1)) return std::nullopt;
    return Assumption{.cause = {fmt::format("the cross kernel K12 is multiplied by {:.3g}", times)}, .cross = times};
  }

  /// The Poisson's ratio that fits best; none where no body has it.
  std::optional<Assumption> best_poisson_ratio() const {
    const double change = best_multiple(pair_.poisson_compliance * (u_.poisson + u_.cross));
    const double own = pair_.poisson_compliance / pair_.shear_compliance;
    const double ratio = change * own;
    if (!(ratio > 0.0 && ratio <= 0.5 && own > 0.0)) return std::nullopt;
    return Assumption{.cause = {fmt::format("Poisson's ratio is {:.3g} instead of {:.3g}", ratio, own)},
                      .poisson = change,
                      .cross = change};
  }

 private:
  /// The factor of a part of the displacement that fits best, one more coefficient in which slip is linear.
  double best_multiple(const ArrayXd& part) const {
    std::vector<ArrayXd> motions = motions_;
    motions.push_back(-part);
    const solver::FittedMotion fitted =
        solver::fit_motion(elastic_ + by_pressure_ - part - imposed_, traction_, at_least(bound_), motions);
    return fitted.coefficients[fitted.coefficients.size() - 1];
  }

  /// Whether it is further away from the factors that have names: missing, right and of the wrong sign.
  static bool is_unnamed(double factor, double away) {
    return std::abs(factor - std::clamp(std::round(factor), -1.0, 1.0)) > away;
  }

  /// The bound, raised to |q| where |q| exceeds it: otherwise the gap could be negative.
  ArrayXd at_least(const ArrayXd& bound) const { return bound.max(solver::norms(traction_)); }

  Cells cells_;
  Displacements u_;
  solver::ElasticPair pair_;
  bool coupled_;
  std::vector<ArrayXd> motions_;  ///< the rotation last
  ArrayXd imposed_;
  ArrayXd elastic_;  ///< by the right law
  ArrayXd by_pressure_;
  ArrayXd traction_;
  ArrayXd bound_;
  ArrayXd stick_;
};

std::vector<Hypothesis> try_kernels(const Trial& trial) {
  const Cause even{"the cross kernel K12, odd in x1 and in x2, is mirrored as an even function"};
  const Cause sign{"the cross kernel K12 has the wrong sign, or the rotation field is (x2, x1) instead of (-x2, x1)"};
  std::vector<Assumption> assumptions{
      {.cause = even, .cross = 0.0, .mirrored = -1.0},
      {.cause = even, .cross = 0.0, .mirrored = 1.0},
      {.cause = {"the cross kernel K12 is missing"}, .cross = 0.0},
      {.cause = sign, .cross = -1.0},
      {.cause = {"the kernels K11 and K22 are exchanged"}, .poisson = 0.0, .exchanged = 1.0},
      {.cause = {"Poisson's ratio is taken as zero"}, .poisson = 0.0, .cross = 0.0}};
  if (const auto ratio = trial.best_poisson_ratio()) assumptions.push_back(*ratio);
  if (const auto times = trial.best_cross()) assumptions.push_back(*times);
  if (trial.coupled()) {
    assumptions.push_back({.cause = {"the kernels K13 and K23 are missing"}, .by_pressure = 0.0});
    assumptions.push_back({.cause = {"the kernels K13 and K23 have the wrong sign"}, .by_pressure = -1.0});
    if (const auto times = trial.best_coupling()) assumptions.push_back(*times);
  }
  std::vector<Hypothesis> tried;
  tried.reserve(assumptions.size());
  for (const Assumption& assumption : assumptions) tried.push_back(trial.of(assumption));
  return tried;
}

/// The highest value that many of some logarithms have, and how many.
struct Highest {
  double value = 0.0;
  std::size_t cells = 0;
};

Highest highest_of(std::vector<double>& logs) {
  constexpr double kFollows = 5e-3;  // relative, of |q|
  constexpr std::size_t kTop = 50;   // one in 50 cells may lie above
  if (logs.empty()) return {};
  const auto top = logs.end() - 1 - static_cast<std::ptrdiff_t>(logs.size() / kTop);
  std::ranges::nth_element(logs, top);
  const double value = *top;
  const auto cells = std::ranges::count_if(logs, [&](double log) { return std::abs(log - value) <= kFollows; });
  return {value, static_cast<std::size_t>(cells)};
}

/// The law |q| = k p^n that most cells follow; and how many follow a multiple of the scene's law.
struct PowerShown {
  double exponent = 0.0;
  double coefficient = 0.0;
  std::size_t cells = 0;
  double multiple = 1.0;
  std::size_t cells_of_multiple = 0;
};

PowerShown power_shown(const GivenContact& c) {
  constexpr int kExponents = 400;  // from 0 to 4
  constexpr double kExponentStep = 0.01;
  std::vector<Index> cells;
  const ArrayXd size = solver::norms(c.traction);
  for (Index cell = 0; cell < size.size(); ++cell) {
    if (size[cell] > 0.0 && c.friction_bound[cell] > 0.0) cells.push_back(cell);
  }
  std::vector<double> logs(cells.size());
  const auto highest_over = [&](const ArrayXd& unit) {
    std::ranges::transform(cells, logs.begin(), [&](Index cell) { return std::log(size[cell] / unit[cell]); });
    return highest_of(logs);
  };
  const Highest own = highest_over(c.friction_bound);
  PowerShown best{.multiple = std::exp(own.value), .cells_of_multiple = own.cells};
  for (int k = 0; k <= kExponents; ++k) {
    const double n = k * kExponentStep;
    const Highest found = highest_over(c.pressure.pow(n));
    if (found.cells > best.cells) {
      best.exponent = n;
      best.coefficient = std::exp(found.value);
      best.cells = found.cells;
    }
  }
  return best;
}

OtherFriction multiple_of_law(const GivenContact& c, double factor) {
  const solver::FrictionLaw& law = c.friction;
  return {{law.is_coulomb() ? fmt::format("the friction coefficient is {:.4g} instead of {:.4g}",
                                          factor * law.coefficient, law.coefficient)
                            : fmt::format("the friction bound is multiplied by {:.4g}", factor)},
          factor * c.friction_bound};
}

/// Another law that the field follows: Coulomb's, Tresca's or a power of the pressure.
std::optional<OtherFriction> other_law(const GivenContact& c) {
  constexpr double kSameExponent = 0.03;
  constexpr double kSameMean = 0.02;
  const PowerShown shown = power_shown(c);
  const solver::FrictionLaw& law = c.friction;
  const auto is = [&](double n) { return std::abs(shown.exponent - n) <= kSameExponent; };
  if (std::max(shown.cells, shown.cells_of_multiple) < kMinSlipping) return std::nullopt;
  constexpr double kAsMany = 0.95;  // follow the scene's own law
  if (static_cast<double>(shown.cells_of_multiple) >= kAsMany * static_cast<double>(shown.cells))
    return multiple_of_law(c, shown.multiple);
  const bool same = (law.is_coulomb() && is(1.0)) || (law.kind == solver::FrictionKind::tresca && is(0.0)) ||
                    (law.kind == solver::FrictionKind::power && is(law.exponent));
  if (same) return std::nullopt;  // nearly the scene's law: something else is wrong
  std::string found = fmt::format("|q| = k p^n with n = {:.2f}", shown.exponent);
  if (is(0.0)) {
    const double mean = law.coefficient * c.pressure.sum() / static_cast<double>((c.pressure > 0.0).count());
    const bool of_mean = law.is_coulomb() && std::abs(shown.coefficient / mean - 1.0) <= kSameMean;
    found = fmt::format("Tresca's, with a shear strength of {:.4g} Pa,{}", shown.coefficient * c.stress_unit,
                        of_mean ? " mu times the mean pressure," : "");
  } else if (is(1.0)) {
    found = fmt::format("Coulomb's, with a coefficient of {:.4g},", shown.coefficient);
  }
  const std::string exponent = law.kind == solver::FrictionKind::power ? fmt::format(", n = {:g}", law.exponent) : "";
  const std::string sentence =
      fmt::format("the law of friction is {} instead of \"{}\"{}", found, solver::to_string(law.kind), exponent);
  return OtherFriction{{sentence}, (c.pressure > 0.0).select(shown.coefficient * c.pressure.pow(shown.exponent), 0.0)};
}

}  // namespace

std::optional<OtherFriction> friction_shown(const GivenContact& contact, const RightAnswer& right,
                                            const Regions& regions) {
  constexpr double kConstant = 0.2;  // spread between the quartiles, over the median excess
  const std::vector<double> excess = ring_excess(contact, right, regions);
  if (excess.empty()) return std::nullopt;
  const double middle = excess[excess.size() / 2];
  const double spread = excess[excess.size() * 3 / 4] - excess[excess.size() / 4];
  if (spread <= kConstant * std::abs(middle)) return multiple_of_law(contact, 1.0 + middle);
  return other_law(contact);
}

ArrayXd stick_cells(const GivenContact& contact) {
  const ArrayXd size = solver::norms(contact.traction);
  const ArrayXd margin =
      solver::kOnCircle * contact.friction_bound + contact.traction_rounding + contact.bound_rounding;
  return ((contact.friction_bound > 0.0) && (size + margin < contact.friction_bound)).cast<double>();
}

Diagnosis diagnose(const GivenContact& contact, const solver::Step& load, double allowed,
                   const std::optional<OtherFriction>& friction, bool half_spaces) {
  const Trial trial(contact, load);
  const Hypothesis right = trial.of(Assumption{});
  std::vector<Hypothesis> tried = half_spaces ? try_kernels(trial) : std::vector<Hypothesis>{};
  // Where hardly any cell sticks, the slipping ones show the kernel.
  const auto shown = right.stick_gap > kExplains * right.gap ? &Hypothesis::stick_gap : &Hypothesis::gap;
  const auto best = std::ranges::min_element(tried, {}, shown);
  std::optional<Hypothesis> kernel;
  const bool explains = best != tried.end() && (*best).*shown <= kExplains * right.*shown;
  if (explains && right.*shown > kNoStickGap) kernel = *best;
  std::optional<Hypothesis> with_friction;
  if (friction) {
    with_friction = trial.of(*friction);
    tried.push_back(*with_friction);
  }
  const Hypothesis& explained = kernel ? *kernel : right;
  return {.reference_kernel = right,
          .tried = std::move(tried),
          .kernel = kernel,
          .friction = with_friction,
          .stick_area_explained = explained.stick_gap <= std::min(allowed, kExplains * explained.gap)};
}

bool directions_explain(const GivenContact& c, const RightAnswer& answer, double allowed) {
  const ArrayXd& right = answer.traction;
  const ArrayXd size = solver::norms(right);
  const ArrayXd turn = ((stick_cells(c) == 0.0) && (size > 0.0)).cast<double>();
  const ArrayXd turned = turn * solver::norms(c.traction) / (size > 0.0).select(size, 1.0);
  const ArrayXd tractions = (1.0 - turn).replicate(2, 1) * c.traction + turned.replicate(2, 1) * right;
  return solver::norms(tractions - right).sum() <= allowed * size.sum();
}

bool keeps_friction(const GivenContact& c, const OtherFriction& friction, double allowed) {
  const ArrayXd size = solver::norms(c.traction);
  return (size - friction.bound).max(0.0).sum() <= allowed * size.sum();
}

}  // namespace slipstick::convergence
