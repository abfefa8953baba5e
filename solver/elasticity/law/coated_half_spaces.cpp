#include "solver/elasticity/law/coated_half_spaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/law/gauss_rule.hpp"
#include "solver/elasticity/law/smooth_traction.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

constexpr double kOverTwoPi = 0.5 / std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The radial functions, in the table's order, with the order of their Bessel function.
enum Radial : Index { kNormal, kMean, kDifference, kCoupling };
constexpr std::array kBesselOrders{0, 0, 2, 1};

/// Components in the order of their numbers in `Component`.
using Components = std::array<double, kAllComponents.size()>;
double& at(Components& values, Component component) { return values[static_cast<std::size_t>(component)]; }

/// Parts of the radial functions that some components need.
struct Needed {
  bool normal = false, tangential = false, coupling = false;

  explicit Needed(std::span<const Component> components) {
    for (const Component component : components) {
      const bool of_pressure = component == Component::k13 || component == Component::k23;
      coupling = coupling || of_pressure;
      normal = normal || component == Component::k33;
      tangential = tangential || (!of_pressure && component != Component::k33);
    }
  }
};

/// Cells are cut until they lie so many of their sides from the singularities, which are two thicknesses away
/// from the plane of the surface. That many Gauss points then leave kRuleError.
constexpr double kMinOffset = 1.75;
constexpr int kMaxPoints = 10;
constexpr double kRuleError = 1e-14;

/// n points leave (4 offset - 2)^(-2n) of a coefficient that itself falls like 1/offset (Trefethen, SIAM
/// Review 50, 2008, theorem 4.5).
const GaussRule& rule_for(double offset) {
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> made;
    for (int n = 1; n <= kMaxPoints; ++n) made.push_back(make_gauss_rule(n));
    return made;
  }();
  const double gained = (4.0 * offset - 2.0) * (4.0 * offset - 2.0);
  std::size_t points = 1;
  for (double left = 1.0 / (offset * gained); left > kRuleError && points < kMaxPoints; left /= gained) {
    ++points;
  }
  return rules[points - 1];
}

/// What the bases add to the coefficients of cells, lengths in units of the thinner layer.
class CellIntegral {
 public:
  CellIntegral(const HankelTable& radial, const Needed& needed) : radial_(radial), needed_(needed) {}

  /// The cell h1 x h2 centred at offset (x, y).
  Components over(double x, double y, double h1, double h2) const {
    Components sums{};
    add(sums, x, y, h1, h2);
    // Odd: exactly zero on the axes.
    if (x == 0.0) at(sums, Component::k12) = at(sums, Component::k13) = 0.0;
    if (y == 0.0) at(sums, Component::k12) = at(sums, Component::k23) = 0.0;
    return sums;
  }

 private:
  void add(Components& sums, double x, double y, double h1, double h2) const {
    const double reach = std::sqrt(x * x + y * y + 4.0);
    if (std::max(h1, h2) * kMinOffset > reach) {
      const bool first = h1 >= h2;
      const double d1 = first ? 0.25 * h1 : 0.0;
      const double d2 = first ? 0.0 : 0.25 * h2;
      add(sums, x - d1, y - d2, h1 - 2.0 * d1, h2 - 2.0 * d2);
      add(sums, x + d1, y + d2, h1 - 2.0 * d1, h2 - 2.0 * d2);
      return;
    }
    const GaussRule& rule1 = rule_for(reach / h1);
    const GaussRule& rule2 = rule_for(reach / h2);
    for (std::size_t i = 0; i < rule1.node.size(); ++i) {
      for (std::size_t j = 0; j < rule2.node.size(); ++j) {
        add_point(sums, x + h1 * rule1.node[i], y + h2 * rule2.node[j],
                  h1 * h2 * rule1.weight[i] * rule2.weight[j]);
      }
    }
  }

  void add_point(Components& sums, double x, double y, double weight) const {
    const double r = std::sqrt(x * x + y * y);
    const HankelTable::Place place = radial_.place(r);
    if (needed_.normal) at(sums, Component::k33) += weight * HankelTable::value(place, kNormal);
    if (r == 0.0) {  // the others have no direction there, and are zero
      if (!needed_.tangential) return;
      const double mean = weight * HankelTable::value(place, kMean);
      at(sums, Component::k11) += mean;
      at(sums, Component::k22) += mean;
      return;
    }
    const double n1 = x / r;
    const double n2 = y / r;
    if (needed_.tangential) {
      const double mean = weight * HankelTable::value(place, kMean);
      const double difference = weight * HankelTable::value(place, kDifference);
      at(sums, Component::k11) += mean + difference * (n1 * n1 - n2 * n2);
      at(sums, Component::k22) += mean - difference * (n1 * n1 - n2 * n2);
      at(sums, Component::k12) += 2.0 * difference * n1 * n2;
    }
    if (needed_.coupling) {
      const double along = weight * HankelTable::value(place, kCoupling);
      at(sums, Component::k13) += along * n1;
      at(sums, Component::k23) += along * n2;
    }
  }

  const HankelTable& radial_;
  Needed needed_;
};

/// The component with the axes exchanged.
Component exchanged(Component component) {
  switch (component) {
    case Component::k11:
      return Component::k22;
    case Component::k22:
      return Component::k11;
    case Component::k13:
      return Component::k23;
    case Component::k23:
      return Component::k13;
    default:
      return component;
  }
}

/// Adds to tables on cells of a grid whose lengths are in units of the thickness. On square cells what lies
/// below the diagonal mirrors what lies above, and a row writes its mirrored column too.
void add_to_tables(std::vector<std::vector<double>>& tables, std::span<const Component> components,
                   const Grid& offsets, double scale, const HankelTable& radial, int threads) {
  const CellIntegral integral(radial, Needed(components));
  const bool square = offsets.h1 == offsets.h2;
  const auto add_row = [&](Index k1) {
    for (Index k2 = square && k1 < offsets.n2 ? k1 : 0; k2 < offsets.n2; ++k2) {
      Components sums = integral.over(static_cast<double>(k1) * offsets.h1,
                                      static_cast<double>(k2) * offsets.h2, offsets.h1, offsets.h2);
      const bool mirrored = square && k1 < k2 && k2 < offsets.n1;
      for (std::size_t c = 0; c < components.size(); ++c) {
        tables[c][static_cast<std::size_t>(k1 * offsets.n2 + k2)] += scale * at(sums, components[c]);
        if (!mirrored) continue;
        tables[c][static_cast<std::size_t>(k2 * offsets.n2 + k1)] +=
            scale * at(sums, exchanged(components[c]));
      }
    }
  };
  // From both ends, so that threads share the triangle evenly.
  in_parts(threads, (offsets.n1 + 1) / 2, [&](int, Index begin, Index end) {
    for (Index k1 = begin; k1 < end; ++k1) {
      add_row(k1);
      if (k1 != offsets.n1 - 1 - k1) add_row(offsets.n1 - 1 - k1);
    }
  });
}

double thickness_of(const CoatedBody& body) { return body.layer ? body.layer->thickness : kInfinite; }

/// The bodies, if there is a law for them.
const CoatedBody& require_valid(const CoatedBody& body, const CoatedBody& other) {
  const bool thick = !body.layer || (body.layer->thickness > 0.0 && std::isfinite(body.layer->thickness));
  const bool soft = !body.layer || std::isfinite(body.layer->elastic.shear_modulus);
  const bool stiff = body.surface().shear_modulus > 0.0 && body.base.shear_modulus > 0.0;
  if (!thick || !soft || !stiff) throw std::invalid_argument("a layer that is neither elastic nor thick");
  if (std::isinf(body.surface().shear_modulus) && std::isinf(other.surface().shear_modulus)) {
    throw std::invalid_argument("two rigid bodies");
  }
  return body;
}

/// Wave numbers times thickness at which the bodies are compared: below and above all their scales.
constexpr double kLeastWave = 1e-12;
constexpr double kLargestWave = 1e2;
constexpr double kWaveRatio = 1.25;
/// Bodies differ by more than this part of their compliance: data have twelve digits.
constexpr double kAlike = 1e-12;
/// Ratios kWaveRatio down from the shortest wave of a grid among which the least compliance is looked for:
/// over six decades.
constexpr int kWavesBelow = 62;
/// Least eigenvalue over the least compliance of a wave.
constexpr double kEigenvalueOfWave = 0.9;

}  // namespace

CoatedHalfSpaces::CoatedHalfSpaces(const CoatedBody& lower, const CoatedBody& upper,
                                   CellTraction cell_traction)
    : lower_(require_valid(lower, upper)),
      upper_(require_valid(upper, lower)),
      lower_symbol_(lower),
      upper_symbol_(upper),
      layers_(elastic_pair(lower.surface(), upper.surface())),
      cell_traction_(cell_traction),
      thickness_(std::min(thickness_of(lower), thickness_of(upper))),
      couples_(layers_.couples()) {
  if (std::isinf(thickness_)) return;
  for (double x = kLeastWave; x < kLargestWave; x *= kWaveRatio) {
    const WaveCompliance pair = compliance(x / thickness_);
    couples_ = couples_ || std::abs(pair.coupling) > kAlike * pair.across;
  }
  radial_.emplace(kBesselOrders, [this](double x) { return beyond_layers(x); });
}

WaveCompliance CoatedHalfSpaces::compliance(double wave_number) const {
  return of_pair(lower_symbol_.whole(wave_number), upper_symbol_.whole(wave_number));
}

/// A tangential symbol T (I - n n^T) + L n n^T is the mean of T and L and, towards twice the angle of n, half
/// of their difference; the transform of that turns its sign.
HankelTable::Values CoatedHalfSpaces::beyond_layers(double x) const {
  const double wave_number = x / thickness_;
  const WaveCompliance pair =
      of_pair(lower_symbol_.beyond_layer(wave_number), upper_symbol_.beyond_layer(wave_number));
  return {kOverTwoPi * pair.normal, kOverTwoPi * 0.5 * (pair.across + pair.along),
          kOverTwoPi * 0.5 * (pair.across - pair.along), -kOverTwoPi * pair.coupling};
}

std::vector<std::vector<double>> CoatedHalfSpaces::influence_tables(std::span<const Component> components,
                                                                    const Grid& offsets, int threads) const {
  const bool smooth = cell_traction_ == CellTraction::smooth;
  const Index more = smooth ? 1 : 0;
  const Grid constant{offsets.n1 + more, offsets.n2 + more, offsets.h1, offsets.h2};
  auto tables = layers_.influence_tables(components, constant, threads);
  if (radial_) {
    const Grid scaled{constant.n1, constant.n2, offsets.h1 / thickness_, offsets.h2 / thickness_};
    add_to_tables(tables, components, scaled, thickness_, *radial_, threads);
  }
  if (!smooth) return tables;
  for (std::size_t c = 0; c < components.size(); ++c) {
    tables[c] = smooth_table(tables[c], parity(components[c]), offsets.n1, offsets.n2);
  }
  return tables;
}

void CoatedHalfSpaces::inverse_symbols(bool tangential, double h1, double h2,
                                       std::span<const PlaneWave> waves, std::span<Symbol> inverses) const {
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const auto [xi1, xi2, length] = waves[i];
    const double modulus = length / sharpening(cell_traction_, xi1 * h1, xi2 * h2);
    const WaveCompliance pair = compliance(length);
    if (!tangential) {
      inverses[i] = {modulus / pair.normal, 0.0, 0.0};
      continue;
    }
    const double across = modulus / pair.across;
    const double excess = modulus / pair.along - across;
    const double n1 = xi1 / length;
    const double n2 = xi2 / length;
    inverses[i] = {across + excess * n1 * n1, excess * n1 * n2, across + excess * n2 * n2};
  }
}

double CoatedHalfSpaces::least_eigenvalue(double h1, double h2) const {
  double wave_number = std::numbers::pi * std::hypot(1.0 / h1, 1.0 / h2);
  double least = kInfinite;
  for (int i = 0; i < kWavesBelow; ++i, wave_number /= kWaveRatio) {
    const WaveCompliance pair = compliance(wave_number);
    least = std::min(least, std::min(pair.across, pair.along) / wave_number);
  }
  return kEigenvalueOfWave * least;
}

void CoatedHalfSpaces::add_to(CacheKey& key) const {
  for (const CoatedBody* const body : {&lower_, &upper_}) {
    key.add(body->base.shear_modulus).add(body->base.poisson_ratio).add(body->layer.has_value());
    if (!body->layer) continue;
    key.add(body->layer->elastic.shear_modulus).add(body->layer->elastic.poisson_ratio);
    key.add(body->layer->thickness);
  }
  key.add(cell_traction_);
}

}  // namespace slipstick::solver
