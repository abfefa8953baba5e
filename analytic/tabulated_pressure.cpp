#include "analytic/tabulated_pressure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "analytic/gsl.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

/// Below this stick radius squares of such small numbers leave the range of a double; all functions have
/// long become their leading terms in c, and c^3 has all but underflowed.
constexpr double kSmallestRatio = 1e-100;
using Points = std::vector<PressurePoint>;

/// p between two knots, by the distance s from the outer one: there, at the edge, p may tend to zero.
class Piece {
 public:
  Piece(PressurePoint inner, PressurePoint outer, double inner_slope, double outer_slope)
      : low_(inner.radius), high_(outer.radius) {
    const double h = high_ - low_;
    const double mean = (inner.pressure - outer.pressure) / h;
    p_ = {outer.pressure, -outer_slope, (3 * mean + 2 * outer_slope + inner_slope) / h,
          -(outer_slope + inner_slope + 2 * mean) / (h * h)};
  }

  double low() const { return low_; }
  double high() const { return high_; }
  double pressure(double s) const { return p_[0] + s * (p_[1] + s * (p_[2] + s * p_[3])); }
  /// dp/dr.
  double slope(double s) const { return -(p_[1] + s * (2 * p_[2] + s * 3 * p_[3])); }
  /// integral of p r^power dr up to a radius in the piece.
  double moment(int power, double radius) const {
    static const gsl::GaussRule rule(4);  // exact up to degree 7
    return rule([&](double r) { return pressure(high_ - r) * std::pow(r, power); }, low_, radius);
  }
  double moment(int power) const { return moment(power, high_); }

 private:
  double low_;
  double high_;
  std::array<double, 4> p_;
};

std::vector<Piece> pieces_of(const Points& points) {
  std::vector<double> radii, pressures;
  for (const auto& [radius, pressure] : points) {
    radii.push_back(radius);
    pressures.push_back(pressure);
  }
  const std::vector<double> slopes = gsl::steffen_slopes(radii, pressures);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    pieces.emplace_back(points[i], points[i + 1], slopes[i], slopes[i + 1]);
  return pieces;
}

/// integral_0^1 p r^power dr.
double whole_moment(const std::vector<Piece>& pieces, int power) {
  double sum = 0;
  for (const Piece& piece : pieces) sum += piece.moment(power);
  return sum;
}

/// asin(t)/2 - t sqrt(1 - t^2)/2 - t^3/(3 sqrt(1 - t^2)) with t = c/rho, times x/rho, x = sqrt(rho^2 - c^2):
/// minus the share of a ring at rho in M_lim - M. It is -1/3 integral_0^t s^4 (1 - s^2)^(-3/2)
/// ds, whose series stands in where the terms cancel.
double lacking(double x, double rho, double c) {
  constexpr double kSeries = 0.5;
  constexpr double kShortSeries = 0.1;
  constexpr std::size_t kTerms = 28;
  constexpr std::size_t kFewTerms = 9;
  static constexpr auto kCoefficients = [] {
    std::array<double, kTerms> table{};
    double binomial = 1;
    for (std::size_t k = 0; k < kTerms; ++k) {
      const auto n = static_cast<double>(k);
      table[k] = binomial / (3 * (2 * n + 5));
      binomial *= (n + 1.5) / (n + 1);
    }
    return table;
  }();
  const double t = c / rho;
  const double y = t * t;
  if (t > kSeries) return (x * std::atan2(c, x) / 2 - t * x * x / rho / 2 - t * t * c / 3) / rho;
  double sum = 0;
  for (std::size_t k = t < kShortSeries ? kFewTerms : kTerms; k-- > 0;) sum = kCoefficients[k] + y * sum;
  return -x / rho * t * y * y * sum;
}

class Tabulated final : public Profile {
 public:
  Tabulated(std::string name, std::vector<Piece> pieces)
      : Profile({.name = std::move(name),
                 .reference_pressure = "mean pressure",
                 .load = 2 * pi * whole_moment(pieces, 1),
                 .moment_limit = whole_moment(pieces, 2) / whole_moment(pieces, 1)}),
        pieces_(std::move(pieces)) {
    double sum = 0;
    for (const Piece& piece : pieces_) {
      inner_moment_.push_back(sum);
      sum += piece.moment(2);
    }
    moment_ = sum;
  }

  double pressure(double radius) const override {
    const Piece& piece = pieces_[piece_at(radius)];
    return std::max(0.0, piece.pressure(piece.high() - radius));
  }

  double twist_integral(StickRadius c) const override {
    if (c.ratio < kSmallestRatio)
      return twist_integral({.ratio = kSmallestRatio, .complement = 1}) +
             pressure(0) * (std::log(kSmallestRatio) - std::log(c.ratio));
    return beyond(c, c.ratio, [](double, double rho, const Piece& piece, double s) { return piece.pressure(s) / rho; });
  }

  /// d/dc of the integral, in u of rho = c cosh(u).
  double twist_slope(StickRadius c) const override {
    const StickRadius at = c.ratio < kSmallestRatio ? StickRadius{.ratio = kSmallestRatio, .complement = 1} : c;
    const double edge_pressure = pieces_.back().pressure(0);
    const double inner =
        beyond(at, at.ratio, [](double, double, const Piece& piece, double s) { return -piece.slope(s); });
    return edge_pressure > 0 ? edge_pressure / std::sqrt(at.complement * (1 + at.ratio)) + inner : inner;
  }
  /// As H', with a factor s/rho: (2/pi) s (p(1)/sqrt(1 - s^2) - integral p'(rho)/sqrt(rho^2 - s^2) drho).
  double punch_density(StickRadius s) const override {
    const double edge_pressure = pieces_.back().pressure(0);
    const double at_edge = edge_pressure > 0 ? edge_pressure / std::sqrt(s.complement * (1 + s.ratio)) : 0;
    return 2 / pi * s.ratio * (at_edge + beyond(s, s.ratio, [](double, double rho, const Piece& piece, double inward) {
                                 return -piece.slope(inward) / rho;
                               }));
  }
  /// All knots, or every so many of them: the jumps of the curvature at the others then cost up to 1e-7 of
  /// the largest stress.
  std::vector<double> kinks() const override {
    constexpr std::size_t kMost = 256;
    const std::size_t step = (pieces_.size() + kMost - 1) / kMost;
    std::vector<double> list;
    for (std::size_t i = step; i < pieces_.size(); i += step) list.push_back(pieces_[i].low());
    return list;
  }

  MomentShare moment_share(StickRadius c) const override {
    constexpr double kHalfway = 0.5;
    if (c.ratio < kHalfway) {
      const double deficit = moment_deficit(c);
      return {.excess = 1 - deficit, .deficit = deficit};
    }
    const double ratio = moment_ratio(c);
    return {.excess = ratio, .deficit = 1 - ratio};
  }

  /// (2/pi) integral (r/rho) p dtheta, rho^2 = c^2 + (c^2 - r^2) tan(theta)^2: a mean of the pressure.
  double stick_traction(StickRadius c, double radius, double inward) const override {
    if (c.ratio < kSmallestRatio) {
      const double scale = kSmallestRatio / c.ratio;
      return stick_traction({.ratio = kSmallestRatio, .complement = 1}, radius * scale, inward * scale);
    }
    if (inward == 0) return pressure(c.ratio);
    const double depth = std::sqrt(inward * (c.ratio + radius));
    return 2 / pi * beyond(c, depth, [depth, radius](double x, double rho, const Piece& piece, double s) {
             return piece.pressure(s) * (radius / rho) * (depth / (x * x + depth * depth));
           });
  }

 private:
  std::size_t piece_at(double radius) const {
    const auto after = std::ranges::upper_bound(pieces_.begin(), pieces_.end() - 1, radius, {}, &Piece::high);
    return static_cast<std::size_t>(after - pieces_.begin());
  }

  /// integral over x = sqrt(rho^2 - c^2) of f(x, rho, piece, s) for rho from c to 1: rho drho = x dx takes
  /// away the square root at c. f is analytic in x but for poles at +-i scale.
  template <class Function>
  double beyond(StickRadius c, double scale, const Function& f) const {
    double sum = 0;
    double from = 0;
    for (std::size_t i = piece_at(c.ratio); i < pieces_.size(); ++i) {
      const Piece& piece = pieces_[i];
      const double end = std::sqrt(-c.beyond(piece.high()) * (piece.high() + c.ratio));
      sum += over_panels(
          [&](double x) {
            const double rho = std::sqrt(c.ratio * c.ratio + x * x);
            return f(x, rho, piece, (end - x) * (end + x) / (piece.high() + rho));
          },
          from, end, scale);
      from = end;
    }
    return sum;
  }

  /// Panels no longer than their distance from the poles, each with as many points as its length over that
  /// distance needs for the last digit.
  template <class Function>
  static double over_panels(const Function& f, double from, double end, double scale) {
    static const gsl::GaussRule few(4), some(8), many(16);
    constexpr double kFew = 0.04;
    constexpr double kSome = 0.35;
    double sum = 0;
    while (from < end) {
      const double distance = std::sqrt(from * from + scale * scale);
      const double to = std::min(end, from + distance);
      const double length = to - from;
      const gsl::GaussRule& rule = length < kFew * distance ? few : length < kSome * distance ? some : many;
      sum += rule(f, from, to);
      from = to;
    }
    return sum;
  }

  /// M/M_lim.
  double moment_ratio(StickRadius c) const {
    const double a_s = c.ratio;
    const double sum = beyond(c, a_s, [a_s](double x, double rho, const Piece& piece, double s) {
      const double ring = a_s * a_s * a_s / 3 + x * (rho * rho * std::atan2(x, a_s) + a_s * x) / 2;
      return piece.pressure(s) / rho * ring;
    });
    return 4 / pi * sum / moment_;
  }

  /// 1 - M/M_lim: all that the pressure within c could carry, less what it does.
  double moment_deficit(StickRadius c) const {
    if (c.ratio < kSmallestRatio) return 0;
    const double a_s = c.ratio;
    const std::size_t i = piece_at(a_s);
    const double inner = inner_moment_[i] + pieces_[i].moment(2, a_s);
    const double outer = beyond(c, a_s, [a_s](double x, double rho, const Piece& piece, double s) {
      return piece.pressure(s) * rho * rho * lacking(x, rho, a_s);
    });
    return (inner + 4 / pi * outer) / moment_;
  }

  std::vector<Piece> pieces_;
  std::vector<double> inner_moment_;  ///< integral of p r^2 dr up to each piece
  double moment_;
};

[[noreturn]] void refuse(const std::string& where, std::string_view what, double value, std::string_view allowed) {
  throw std::invalid_argument(fmt::format("{}: {} = {}; allowed: {}", where, what, value, allowed));
}

void check_points(const std::string& name, const Points& points, const std::vector<std::string>& places) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [radius, pressure] = points[i];
    if (i == 0 && radius != 0) refuse(places[i], "radius", radius, "0 at the first point");
    if (i > 0 && !(radius > points[i - 1].radius && std::isfinite(radius)))
      refuse(places[i], "radius", radius, fmt::format("finite and more than the one before, {}", points[i - 1].radius));
    if (!(pressure >= 0 && std::isfinite(pressure))) refuse(places[i], "pressure", pressure, "finite and not negative");
    if (pressure == 0 && i + 1 < points.size())
      refuse(places[i], "pressure", pressure, "> 0 except at the last point, where the contact ends");
  }
  constexpr std::size_t kMin = 16;  // every second of fewer points gives a poor error estimate
  if (points.size() < kMin)
    throw std::invalid_argument(fmt::format(
        "{}: {} points; allowed: at least {}, since the error of fewer cannot be estimated; best are points "
        "that crowd towards the edge",
        name, points.size(), kMin));
}

/// Where H does not decrease the tractions of a circle that sticks would exceed friction within it.
void check_that_a_circle_sticks(const Profile& profile, const Points& points, const std::vector<std::string>& places) {
  constexpr std::size_t kMax = 200;  // more checks would say little and cost more than the profile
  const std::size_t step = 1 + points.size() / kMax;
  for (std::size_t i = 1; i + 1 < points.size(); i += step) {
    const double c = points[i].radius;
    if (!(profile.twist_slope({.ratio = c, .complement = 1 - c}) > 0))
      throw std::invalid_argument(fmt::format(
          "{}: the pressure rises beyond this radius so steeply that slip would not begin at the edge and no "
          "circle stick; allowed: pressures that fall outwards, or nearly",
          places[i]));
  }
}

/// Bytes of a table, a hundred times as many as resolve any pressure.
constexpr std::uintmax_t kLargestPressureTable = std::uintmax_t{1} << 20;
/// Characters of a line that a message shows.
constexpr std::size_t kMaxShown = 200;
/// Written by some programs at the beginning of a text.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

double parse_number(std::string_view text, std::string_view what, const std::string& where) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(fmt::format("{}: {} = {}; allowed: a number", where, what, text.substr(0, kMaxShown)));
  return value;
}

PressurePoint parse_point(std::string_view line, const std::string& where) {
  const auto comma = line.find(',');
  if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos)
    throw std::invalid_argument(fmt::format("{}: {}; allowed: radius,pressure", where, line.substr(0, kMaxShown)));
  return {.radius = parse_number(trimmed(line.substr(0, comma)), "radius", where),
          .pressure = parse_number(trimmed(line.substr(comma + 1)), "pressure", where)};
}

bool is_header(std::string_view line) {
  const auto comma = line.find(',');
  return comma != std::string_view::npos && trimmed(line.substr(0, comma)) == "radius" &&
         trimmed(line.substr(comma + 1)) == "pressure";
}

/// Folders, devices and pipes have no size.
std::ifstream open_table(const std::string& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream;
  if (!error && size <= kLargestPressureTable) stream.open(file);
  if (!stream.is_open()) {
    const std::string reason = size > kLargestPressureTable && !error ? "it is larger"
                               : error                                ? error.message()
                                                                      : "permission denied";
    throw std::invalid_argument(fmt::format("{}: cannot be read ({}); allowed: a CSV file of at most {} MiB", file,
                                            reason, kLargestPressureTable >> 20));
  }
  return stream;
}

}  // namespace

InterpolatedPressure interpolate(const std::string& name, Points points) {
  const double mean = 2 * whole_moment(pieces_of(points), 1);
  for (auto& point : points) point.pressure /= mean;
  return {.profile = std::make_unique<const Tabulated>(name, pieces_of(points)), .mean_pressure = mean};
}

double interpolated_pressure(const Points& points, double radius) {
  for (const Piece& piece : pieces_of(points))
    if (radius <= piece.high()) return piece.pressure(piece.high() - radius);
  throw std::logic_error("a radius beyond the last point");
}

TabulatedProfile tabulated_profile(const std::string& name, std::vector<PressurePoint> points,
                                   std::vector<std::string> places) {
  while (places.size() < points.size()) places.push_back(fmt::format("{}, point {}", name, places.size() + 1));
  check_points(name, points, places);
  const double a = points.back().radius;
  const double peak = std::ranges::max_element(points, {}, &PressurePoint::pressure)->pressure;
  for (auto& point : points) point = {.radius = point.radius / a, .pressure = point.pressure / peak};

  auto [profile, mean] = interpolate("file:" + name, points);
  check_that_a_circle_sticks(*profile, points, places);
  return {.profile = std::move(profile),
          .radius = a,
          .mean_pressure = peak * mean,
          .points = std::move(points),
          .largest_pressure = peak};
}

TabulatedProfile read_tabulated_profile(const std::string& file) {
  std::ifstream stream = open_table(file);
  std::vector<PressurePoint> points;
  std::vector<std::string> places;
  std::size_t number = 0;
  for (std::string text; std::getline(stream, text);) {
    ++number;
    if (number == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    const std::string_view line = trimmed(text);
    if (line.empty() || line.front() == '#' || (points.empty() && is_header(line))) continue;
    places.push_back(fmt::format("{}:{}", file, number));
    points.push_back(parse_point(line, places.back()));
  }
  return tabulated_profile(file, std::move(points), std::move(places));
}

}  // namespace slipstick::analytic
