#include "solver/scene/shape_kind.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "solver/scene/bracketed_root.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/scene/validate.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::numbers::pi;
using Axes = std::array<double, 2>;

Axes circle(double radius) { return {radius, radius}; }

using Gap = Eigen::Ref<ArrayXd>;

/// Writes the points' distances from the axis where their gap will stand.
void write_distance(const ArrayXd& along, const ArrayXd& across, Gap r) {
  r = (along.square() + across.square()).sqrt();
}

void paraboloid_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  const auto [radius_1, radius_2] = paraboloid_radii(s);
  gap = along.square() / (2.0 * radius_1) + across.square() / (2.0 * radius_2);
}
Axes paraboloid_contact(const Surface& s, double load, double effective_modulus) {
  const auto [radius_1, radius_2] = paraboloid_radii(s);
  const HertzContact contact = hertz_contact(load, radius_1, radius_2, effective_modulus);
  return {contact.semi_axis_1, contact.semi_axis_2};
}
Axes paraboloid_below(const Surface& s, double depth) {
  const auto [radius_1, radius_2] = paraboloid_radii(s);
  return {std::sqrt(2.0 * radius_1 * depth), std::sqrt(2.0 * radius_2 * depth)};
}

void cone_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap *= s.slope;
}
/// Sneddon 1965: W = (pi/2) E* a^2 slope.
Axes cone_contact(const Surface& s, double load, double effective_modulus) {
  return circle(std::sqrt(2.0 * load / (pi * effective_modulus * s.slope)));
}
Axes cone_below(const Surface& s, double depth) { return circle(depth / s.slope); }

void flat_punch_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap = (gap >= s.inner_radius && gap <= s.radius)
            .select(ArrayXd::Zero(gap.size()),
                    ArrayXd::Constant(gap.size(), std::numeric_limits<double>::infinity()));
}
Axes flat_punch_contact(const Surface& s, double /*load*/, double /*effective_modulus*/) {
  return circle(s.radius);
}
Axes flat_punch_below(const Surface& s, double /*depth*/) { return circle(s.radius); }

void rounded_punch_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap = (gap - s.flat_radius).max(0.0).square() / (2.0 * s.corner_radius);
}
/// Sneddon 1965: W = 2 E* integral_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr for a gap f, here (r - b)^2/(2 R) beyond
/// the flat radius b. The contact reaches further than the flat face, but not by more than the radius of a
/// sphere R under the same load.
Axes rounded_punch_contact(const Surface& surface, double load, double effective_modulus) {
  const double b = surface.flat_radius;
  const auto carried = [&](double a) {
    const double s = b / a;
    const double c = std::sqrt(1.0 - s * s);
    return 2.0 * effective_modulus * a * a / surface.corner_radius *
           (a * c * (1.0 - c * c / 3.0) - 0.5 * b * (std::acos(s) + s * c));
  };
  const double reach = std::cbrt(0.75 * load * surface.corner_radius / effective_modulus);
  return circle(bracketed_root([&](double a) { return carried(a) / load - 1.0; }, b, b + reach));
}
Axes rounded_punch_below(const Surface& s, double depth) {
  return circle(s.flat_radius + std::sqrt(2.0 * s.corner_radius * depth));
}

void power_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap = s.coefficient * gap.pow(s.exponent);
}
/// Sneddon's integral of the gap coefficient r^exponent.
Axes power_contact(const Surface& s, double load, double effective_modulus) {
  const double n = s.exponent;
  const double integral = 0.5 * std::sqrt(pi) * std::tgamma(0.5 * n + 1.0) / std::tgamma(0.5 * n + 1.5);
  return circle(std::pow(load / (2.0 * effective_modulus * s.coefficient * n * integral), 1.0 / (n + 1.0)));
}
Axes power_below(const Surface& s, double depth) {
  return circle(std::pow(depth / s.coefficient, 1.0 / s.exponent));
}

const std::array kKinds{
    ShapeKind{"sphere", Shape::sphere, paraboloid_gap, paraboloid_contact, paraboloid_below},
    ShapeKind{"ellipsoid", Shape::ellipsoid, paraboloid_gap, paraboloid_contact, paraboloid_below},
    ShapeKind{"cone", Shape::cone, cone_gap, cone_contact, cone_below},
    ShapeKind{"flat_punch", Shape::flat_punch, flat_punch_gap, flat_punch_contact, flat_punch_below},
    ShapeKind{"rounded_punch", Shape::rounded_punch, rounded_punch_gap, rounded_punch_contact,
              rounded_punch_below},
    ShapeKind{"power", Shape::power, power_gap, power_contact, power_below},
    ShapeKind{"height_map", Shape::height_map, nullptr, nullptr, nullptr},
    ShapeKind{"roughness", Shape::roughness, nullptr, nullptr, nullptr}};

}  // namespace

std::array<double, 2> paraboloid_radii(const Surface& s) {
  return s.shape == Shape::sphere ? circle(s.radius) : Axes{s.radius_1, s.radius_2};
}

const ShapeKind& kind_of(Shape shape) { return *std::ranges::find(kKinds, shape, &ShapeKind::shape); }

const Words<Shape>& shape_words() {
  static const Words<Shape> words = [] {
    Words<Shape> made;
    for (const ShapeKind& kind : kKinds) made.emplace_back(kind.word, kind.shape);
    return made;
  }();
  return words;
}

std::vector<std::string> words_with_axis() {
  std::vector<std::string> words;
  for (const ShapeKind& kind : kKinds) {
    if (kind.gap != nullptr) words.push_back(kind.word);
  }
  return words;
}

bool ShapeNumber::belongs_to(Shape shape) const { return std::ranges::find(shapes, shape) != shapes.end(); }

const std::vector<ShapeNumber>& shape_numbers() {
  using Name = const char*;
  const auto own = [](Name name, Name unit, const Range& allowed, Name meaning, std::vector<Shape> shapes,
                      double Surface::*at) {
    return ShapeNumber{name, unit, allowed, meaning, std::move(shapes), at, nullptr};
  };
  const auto rough = [](Name name, Name unit, const Range& allowed, Name meaning, double Roughness::*at) {
    return ShapeNumber{name, unit, allowed, meaning, {Shape::roughness}, nullptr, at};
  };
  static const std::vector<ShapeNumber> numbers{
      own("radius", "m", kPositive, "Radius of the sphere, or of the punch's face.",
          {Shape::sphere, Shape::flat_punch}, &Surface::radius),
      own("radius_1", "m", kPositive, "Radius of curvature along the ellipsoid's first axis.",
          {Shape::ellipsoid}, &Surface::radius_1),
      own("radius_2", "m", kPositive, "Radius of curvature along its second axis.", {Shape::ellipsoid},
          &Surface::radius_2),
      own("slope", "", kPositive, "Gap over radius.", {Shape::cone}, &Surface::slope),
      own("flat_radius", "m", kPositive, "Radius of the flat face.", {Shape::rounded_punch},
          &Surface::flat_radius),
      own("corner_radius", "m", kPositive,
          "Radius of curvature beyond the face, where the gap is (r - flat_radius)^2/(2 corner_radius).",
          {Shape::rounded_punch}, &Surface::corner_radius),
      own("exponent", "", kExponent, "The gap is coefficient r^exponent.", {Shape::power},
          &Surface::exponent),
      own("coefficient", "m^(1 - exponent)", kPositive, "Factor of that power.", {Shape::power},
          &Surface::coefficient),
      rough("hurst", "", kHurst,
            "Hurst's exponent: the power of a wave vector k goes like |k|^(-2 (1 + hurst)).",
            &Roughness::hurst),
      rough("rms_slope", "", kPositive, "Root mean square of the gradient's length, over a period.",
            &Roughness::rms_slope),
      rough("longest", "m", kPositive, "Longest wavelength.", &Roughness::longest)};
  return numbers;
}

std::vector<double*> lengths(Surface& surface) {
  std::vector<double*> found{&surface.inner_radius,    &surface.at[0],          &surface.at[1],
                             &surface.map.spacing[0],  &surface.map.spacing[1], &surface.roughness.shortest,
                             &surface.roughness.period};
  for (const ShapeNumber& number : shape_numbers()) {
    if (number.unit == "m") found.push_back(&number.of(surface));
  }
  return found;
}

}  // namespace slipstick::solver
