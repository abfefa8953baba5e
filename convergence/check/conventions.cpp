#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "convergence/check/foreign_field.hpp"
#include "solver/contact/certificate.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;
using solver::InputError;

/// Ratio of numbers in the same unit: below the root of 1000, by which units of one kind differ.
constexpr double kSameUnit = 31.6;

/// Relative error of the load that confirms guessed units.
constexpr double kCorrectedLoad = 0.2;

/// Part of a cell up to which sums over cells know a contact's middle.
constexpr double kInPlace = 1e-2;

struct Unit {
  const char* name;
  double size;
};
constexpr std::array<Unit, 4> kLengths{{{"m", 1.0}, {"mm", 1e-3}, {"micrometres", 1e-6}, {"nm", 1e-9}}};
constexpr std::array<Unit, 4> kStresses{{{"Pa", 1.0}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}}};

/// The unit that explains a ratio of the file's number to the expected one.
std::optional<Unit> find_unit(const std::array<Unit, 4>& units, double ratio) {
  for (const Unit& unit : units) {
    const double left = ratio * unit.size;
    if (left > 1.0 / kSameUnit && left < kSameUnit) return unit;
  }
  return std::nullopt;
}

double longer_side(const solver::Grid& grid) {
  return std::max(static_cast<double>(grid.n1) * grid.h1, static_cast<double>(grid.n2) * grid.h2);
}

/// The approximate width of the contact, in m.
double expected_width(const solver::Model& model, const OracleAnswer& exact) {
  const bool known = exact.oracle && std::isfinite(exact.oracle->contact_radius);
  return known ? 2.0 * exact.oracle->longer_semi_axis() : longer_side(model.grid) * model.length_unit;
}

void correct_length(Interpretation& read, const solver::Scene& scene, double expected) {
  ForeignField& field = read.field;
  const double width = longer_side(field.grid);
  const auto unit = find_unit(kLengths, width / expected);
  if (!unit) {
    throw InputError(field.file.string(),
                     fmt::format("the cells reach over {:.4g}; allowed: positions in m, where the contact of {} "
                                 "is about {:.4g} wide (mm, micrometres and nm are understood)",
                                 width, scene.source.string(), expected));
  }
  if (unit->size == 1.0) return;
  read.conventions.push_back(
      fmt::format("positions look like {}: the cells reach over {:.4g}, the contact is about "
                  "{:.4g} m wide",
                  unit->name, width, expected));
  for (double* length : {&field.grid.h1, &field.grid.h2, &field.centre[0], &field.centre[1]}) {
    *length *= unit->size;
  }
}

void correct_stress(Interpretation& read, const solver::Step& load) {
  ForeignField& field = read.field;
  if (!load.normal) return;
  const double carried = field.pressure.sum() * field.grid.cell_area();
  const auto unit = find_unit(kStresses, carried / *load.normal);
  if (!unit) {
    throw InputError(field.file.string(),
                     fmt::format("the pressure carries {:.6g} N if it is in Pa; allowed: about {}.normal = {} N "
                                 "(kPa, MPa and GPa are understood)",
                                 carried, load.key, *load.normal));
  }
  const double off = carried * unit->size / *load.normal - 1.0;
  const bool corrected = unit->size != 1.0 || !read.conventions.empty();
  if (corrected && !(std::abs(off) < kCorrectedLoad)) {
    throw InputError(field.file.string(),
                     fmt::format("in no units that are understood does the pressure carry {}.normal = {} N; allowed: "
                                 "positions in m and stresses in Pa (nm, micrometres, mm, kPa, MPa and GPa are "
                                 "understood)",
                                 load.key, *load.normal));
  }
  if (unit->size == 1.0) return;
  read.conventions.push_back(
      fmt::format("pressure and tractions look like {}: in Pa they would carry {:.4g} N of "
                  "{} N",
                  unit->name, carried, *load.normal));
  for (ArrayXd* stress : {&field.pressure, &field.traction, &field.pressure_rounding, &field.traction_rounding}) {
    *stress *= unit->size;
  }
}

/// Rearranges each field by `place`, a function of its matrix, in which x2 runs down the columns.
template <typename Place>
void rearrange(ForeignField& field, const solver::Grid& from, const Place& place) {
  const auto placed = [&](const ArrayXd& values) {
    return ArrayXd(place(values.reshaped(from.n2, from.n1)).reshaped());
  };
  for (ArrayXd* values : {&field.pressure, &field.pressure_rounding, &field.traction_rounding}) {
    *values = placed(*values);
  }
  field.traction << placed(field.traction.head(from.cells())), placed(field.traction.tail(from.cells()));
}

/// Mean of x1^2 over mean of x2^2 under the pressure, about its centre.
double aspect(const ForeignField& field) {
  const auto variance = [&](const ArrayXd& x) {
    const double mean = (field.pressure * x).sum() / field.pressure.sum();
    return (field.pressure * (x - mean).square()).sum();
  };
  return variance(solver::cell_x1(field.grid)) / variance(solver::cell_x2(field.grid));
}

/// Only an elliptic contact along the axes shows whether they are exchanged, wherever it stands.
void correct_axes(Interpretation& read, const solver::Scene& scene) {
  ForeignField& field = read.field;
  std::vector<solver::Surface> surfaces = scene.surfaces;
  surfaces.front().at = {};
  const auto radii = solver::hertzian_radii(surfaces);
  if (!radii || !is_bare(scene)) return;
  const solver::HertzContact shape = solver::hertz_contact(1.0, (*radii)[0], (*radii)[1], 1.0);
  const double ratio = shape.semi_axis_1 / shape.semi_axis_2;
  const double expected = 2.0 * std::log(ratio);
  const double found = std::log(aspect(field));
  if (!(std::abs(found + expected) < 0.5 * std::abs(found - expected))) return;
  read.conventions.push_back("axes look exchanged: the contact's long axis lies along the file's other coordinate");
  const solver::Grid from = field.grid;
  const Index cells = from.cells();
  field.grid = {from.n2, from.n1, from.h2, from.h1};
  std::swap(field.centre[0], field.centre[1]);
  field.traction.head(cells).swap(field.traction.tail(cells));
  rearrange(field, from, [](const auto& values) { return values.transpose(); });
}

/// Whether the scene has one smooth body about an axis, whose pressure is computed.
bool has_axis(const solver::Scene& scene) {
  return scene.surfaces.size() == 1 && scene.contact.pressure != solver::PressureModel::file &&
         solver::find_height_map(scene.surfaces) == nullptr && scene.surfaces.front().shape != solver::Shape::roughness;
}

/// Sum of the distances of a field's pressure from the exact one, at its cells.
double distance_from(const Oracle& exact, const ForeignField& field) {
  const ArrayXd x1 = solver::cell_x1(field.grid);
  const ArrayXd x2 = solver::cell_x2(field.grid);
  double distance = 0.0;
  for (Index cell = 0; cell < x1.size(); ++cell) {
    if (!(field.pressure[cell] > 0.0)) continue;
    const double radius = exact.radius(x1[cell] + field.centre[0] - exact.place.centre[0],
                                       x2[cell] + field.centre[1] - exact.place.centre[1]);
    distance += std::abs(field.pressure[cell] - exact.pressure(std::max(radius, 0.35 * field.grid.h1)));
  }
  return distance;
}

/// Moves a field that counts from its grid's corner: all of its cells lie at positive coordinates, and its
/// middle is half a side away from the middle of the scene's pressure.
void correct_corner(Interpretation& read, const solver::Scene& scene, const solver::Model& model) {
  ForeignField& field = read.field;
  const solver::Grid& grid = model.grid;
  if (!(2.0 * field.centre[0] > static_cast<double>(field.grid.n1 - 2) * field.grid.h1 &&
        2.0 * field.centre[1] > static_cast<double>(field.grid.n2 - 2) * field.grid.h2))
    return;
  const ArrayXd pressure = solver::find_pressure(scene, model, scene.steps.front()).pressure;
  const auto middle = [](const ArrayXd& p, const ArrayXd& x) { return (p * x).sum() / p.sum(); };
  const std::array<double, 2> expected{middle(pressure, solver::cell_x1(grid)) * model.length_unit,
                                       middle(pressure, solver::cell_x2(grid)) * model.length_unit};
  const std::array<double, 2> found{field.centre[0] + middle(field.pressure, solver::cell_x1(field.grid)),
                                    field.centre[1] + middle(field.pressure, solver::cell_x2(field.grid))};
  const solver::Grid in_m = model.grid_in_m();
  const std::array<double, 2> half{0.5 * static_cast<double>(in_m.n1) * in_m.h1,
                                   0.5 * static_cast<double>(in_m.n2) * in_m.h2};
  for (const double first : {0.5, 0.0}) {  // the first cell's centre, in cells
    const std::array<double, 2> by{half[0] - (0.5 - first) * field.grid.h1, half[1] - (0.5 - first) * field.grid.h2};
    if (!(std::abs(found[0] - by[0] - expected[0]) <= 0.25 * field.grid.h1 &&
          std::abs(found[1] - by[1] - expected[1]) <= 0.25 * field.grid.h2))
      continue;
    for (std::size_t k = 0; k < 2; ++k) field.centre[k] -= by[k];
    read.conventions.push_back(
        fmt::format("positions count from the grid's corner: moved by ({:.4g}, {:.4g}) m to its middle", by[0], by[1]));
    return;
  }
}

/// Moves a contact onto its body's axis. A contact that stood a cell or more away was in other coordinates.
void correct_origin(Interpretation& read, const solver::Scene& scene, const solver::Model& model,
                    const OracleAnswer& exact) {
  ForeignField& field = read.field;
  if (!has_axis(scene)) return correct_corner(read, scene, model);
  const double total = field.pressure.sum();
  std::array<double, 2> off{};
  for (std::size_t k = 0; k < 2; ++k) {
    const ArrayXd x = k == 0 ? solver::cell_x1(field.grid) : solver::cell_x2(field.grid);
    off[k] = field.centre[k] + (field.pressure * x).sum() / total - scene.surfaces.front().at[k];
  }
  const double cells = std::max(std::abs(off[0]) / field.grid.h1, std::abs(off[1]) / field.grid.h2);
  if (!(cells > (scene.contact.coupling == solver::Coupling::full ? 1.0 : kInPlace))) return;
  ForeignField moved = field;
  for (std::size_t k = 0; k < 2; ++k) moved.centre[k] -= off[k];
  const bool known = exact.oracle && std::isfinite(exact.oracle->contact_radius);
  if (known && !(distance_from(*exact.oracle, moved) < distance_from(*exact.oracle, field))) return;  // rows are lost
  field = std::move(moved);
  if (cells < 1.0) return;
  read.conventions.push_back(
      fmt::format("the contact's middle stands ({:.4g}, {:.4g}) m from the scene's: moved there", off[0], off[1]));
}

/// A way to write tractions: on the other body, in a left-handed frame, with exchanged columns, or by mistake
/// with one component reversed. The members are applied in their order.
struct Orientation {
  bool mirrored = false;   ///< x2 counts the other way, and q2 with it
  bool exchanged = false;  ///< q1 and q2
  double sign1 = 1.0;
  double sign2 = 1.0;

  bool is_mistake() const { return sign1 != sign2; }

  std::string text() const {
    std::vector<std::string> parts;
    if (mirrored) parts.emplace_back("x2 and q2 look reversed (a left-handed frame)");
    if (exchanged) parts.emplace_back("q1 and q2 look exchanged");
    if (is_mistake()) {
      parts.push_back(fmt::format("only {} looks reversed, as with the rotation field (x2, x1) instead of (-x2, x1)",
                                  sign1 < 0.0 ? "q1" : "q2"));
    } else if (sign1 < 0.0) {
      parts.emplace_back("tractions look reversed (those on the other body, or a moment that turns the other way)");
    }
    return fmt::format("{}: only then do they carry the scene's loads", fmt::join(parts, ", and "));
  }
};

/// The field with its orientation undone. middle: x2 of the mirror.
ForeignField turned(ForeignField field, const Orientation& orientation, double middle) {
  const Index cells = field.grid.cells();
  if (orientation.mirrored) {
    field.centre[1] = 2.0 * middle - field.centre[1];
    rearrange(field, field.grid, [](const auto& values) { return values.colwise().reverse(); });
    field.traction.tail(cells) *= -1.0;
  }
  if (orientation.exchanged) field.traction.head(cells).swap(field.traction.tail(cells));
  field.traction.head(cells) *= orientation.sign1;
  field.traction.tail(cells) *= orientation.sign2;
  return field;
}

/// The distance of the tractions' loads from the scene's, as a part of the limit loads.
class LoadMismatch {
 public:
  LoadMismatch(const ForeignField& field, const solver::Scene& scene, const OracleAnswer& exact)
      : load_(scene.steps.front()),
        friction_(scene.contact.friction.bound(field.pressure).sum()),
        limit_(solver::free_moment_limit(field.grid, scene.contact.friction.bound(field.pressure))),
        moment_(known_moment(scene, exact, limit_, field.grid.cell_area())),
        rotation_(rotation_about_origin(field.grid, field.centre)) {
    const double area = field.grid.cell_area();
    const double twist = solver::value_if<solver::Twist>(load_.torsion).value_or(0.0);
    sense_ = std::copysign(twist == 0.0 ? 0.0 : 1.0, twist);
    for (std::size_t k = 0; k < 2; ++k) force_[k] = load_.force[k] / area / friction_;
  }

  double operator()(const ArrayXd& traction) const {
    const Index cells = traction.size() / 2;
    const double moment = (traction * rotation_).sum();
    const double off = moment_ ? std::abs(moment - *moment_) / limit_
                               : std::abs(moment / (solver::norms(traction) * solver::norms(rotation_)).sum() - sense_);
    if (load_.displacement) return off;
    return off + std::hypot(traction.head(cells).sum() / friction_ - force_[0],
                            traction.tail(cells).sum() / friction_ - force_[1]);
  }

  /// The distance without any traction.
  double size() const {
    const double force = load_.displacement ? 0.0 : std::hypot(force_[0], force_[1]);
    return std::abs(moment_ ? *moment_ / limit_ : sense_) + force;
  }

 private:
  const solver::Step& load_;
  double friction_;  ///< all loads over the cell area
  double limit_;
  std::optional<double> moment_;
  ArrayXd rotation_;
  double sense_;  ///< of an imposed twist
  std::array<double, 2> force_{};
};

/// Loads that are wrong by less than half are an error of the field and stay. Otherwise the orientation is
/// undone that brings them closest to the scene's, the first one of several; mistakes come last.
void correct_orientation(Interpretation& read, const solver::Scene& scene, const OracleAnswer& exact) {
  constexpr std::array<Orientation, 9> kOrientations{{{.sign1 = -1.0, .sign2 = -1.0},
                                                      {.mirrored = true},
                                                      {.mirrored = true, .sign1 = -1.0, .sign2 = -1.0},
                                                      {.exchanged = true},
                                                      {.exchanged = true, .sign1 = -1.0, .sign2 = -1.0},
                                                      {.sign1 = -1.0},
                                                      {.sign2 = -1.0},
                                                      {.exchanged = true, .sign1 = -1.0},
                                                      {.exchanged = true, .sign2 = -1.0}}};
  constexpr double kClearlyCloser = 1e-3;  // part of the loads by which a later orientation has to be closer
  const LoadMismatch here(read.field, scene, exact);
  double least = 0.5 * here.size();
  if (!(here(read.field.traction) > least)) return;
  const double middle = has_axis(scene) ? scene.surfaces.front().at[1] : 0.0;
  const Orientation* best = nullptr;
  for (const Orientation& orientation : kOrientations) {
    const ForeignField field = turned(read.field, orientation, middle);
    const double off = LoadMismatch(field, scene, exact)(field.traction);
    if (!(off < least - (best ? kClearlyCloser * here.size() : 0.0))) continue;
    least = off;
    best = &orientation;
  }
  if (best == nullptr) return;
  read.field = turned(std::move(read.field), *best, middle);
  (best->is_mistake() ? read.mistakes : read.conventions).push_back(best->text());
}

}  // namespace

std::optional<double> known_moment(const solver::Scene& scene, const OracleAnswer& exact, double limit, double unit) {
  const solver::TorsionLoad& torsion = scene.steps.front().torsion;
  if (exact.oracle && std::isfinite(exact.oracle->moment)) return exact.oracle->moment / unit;
  if (const auto moment = solver::value_if<solver::Moment>(torsion)) return *moment / unit;
  if (const auto ratio = solver::value_if<solver::MomentRatio>(torsion)) return *ratio * limit;
  return std::nullopt;
}

Interpretation in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                  const OracleAnswer& exact) {
  Interpretation read{std::move(field), {}, {}};
  correct_length(read, scene, expected_width(model, exact));
  correct_stress(read, scene.steps.front());
  correct_axes(read, scene);
  correct_origin(read, scene, model, exact);
  correct_orientation(read, scene, exact);
  return read;
}

}  // namespace slipstick::convergence
