#include "convergence/check/conventions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/certificate.hpp"
#include "solver/input_error.hpp"
#include "solver/limit_load.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;
using solver::InputError;

/// Units of one kind differ by thousands: a ratio nearer to one than the root of that is no question of
/// units.
constexpr double kSameUnit = 31.6;

/// Where units had to be guessed the load has to confirm them.
constexpr double kMendedLoad = 0.2;

struct Unit {
  const char* name;
  double size;
};
constexpr std::array<Unit, 4> kLengths{{{"m", 1.0}, {"mm", 1e-3}, {"micrometres", 1e-6}, {"nm", 1e-9}}};
constexpr std::array<Unit, 4> kStresses{{{"Pa", 1.0}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}}};

/// ratio: of the number in the file to the one expected.
std::optional<Unit> find_unit(const std::array<Unit, 4>& units, double ratio) {
  for (const Unit& unit : units) {
    const double left = ratio * unit.size;
    if (left > 1.0 / kSameUnit && left < kSameUnit) return unit;
  }
  return std::nullopt;
}

/// About how wide the contact is, in m.
double expected_width(const solver::Model& model, const OracleAnswer& exact) {
  if (exact.oracle && std::isfinite(exact.oracle->contact_radius))
    return 2.0 * exact.oracle->longer_semi_axis();
  const solver::Grid& grid = model.grid;
  return std::max(static_cast<double>(grid.n1) * grid.h1, static_cast<double>(grid.n2) * grid.h2) *
         model.length_unit;
}

void mend_length(ForeignField& field, const solver::Scene& scene, double expected) {
  const double width = std::max(static_cast<double>(field.grid.n1) * field.grid.h1,
                                static_cast<double>(field.grid.n2) * field.grid.h2);
  const auto unit = find_unit(kLengths, width / expected);
  if (!unit) {
    throw InputError(
        field.file.string(),
        fmt::format("the cells reach over {:.4g}; allowed: positions in m, where the contact of {} "
                    "is about {:.4g} wide (mm, micrometres and nm are understood)",
                    width, scene.source.string(), expected));
  }
  if (unit->size == 1.0) return;
  field.notes.push_back(
      fmt::format("positions look like {}: the cells reach over {:.4g}, the contact is about "
                  "{:.4g} m wide",
                  unit->name, width, expected));
  for (double* length : {&field.grid.h1, &field.grid.h2, &field.centre[0], &field.centre[1]}) {
    *length *= unit->size;
  }
}

void mend_stress(ForeignField& field, const solver::Step& load) {
  if (!load.normal) return;
  const double carried = field.pressure.sum() * field.grid.cell_area();
  const auto unit = find_unit(kStresses, carried / *load.normal);
  if (!unit) {
    throw InputError(
        field.file.string(),
        fmt::format("the pressure carries {:.6g} N if it is in Pa; allowed: about {}.normal = {} N "
                    "(kPa, MPa and GPa are understood)",
                    carried, load.key, *load.normal));
  }
  const double off = carried * unit->size / *load.normal - 1.0;
  const bool mended = unit->size != 1.0 || !field.notes.empty();
  if (mended && !(std::abs(off) < kMendedLoad)) {
    throw InputError(
        field.file.string(),
        fmt::format("in no units that are understood does the pressure carry {}.normal = {} N; allowed: "
                    "positions in m and stresses in Pa (nm, micrometres, mm, kPa, MPa and GPa are "
                    "understood)",
                    load.key, *load.normal));
  }
  if (unit->size == 1.0) return;
  field.notes.push_back(
      fmt::format("pressure and tractions look like {}: in Pa they would carry {:.4g} N of "
                  "{} N",
                  unit->name, carried, *load.normal));
  for (ArrayXd* stress :
       {&field.pressure, &field.traction, &field.pressure_rounding, &field.traction_rounding}) {
    *stress *= unit->size;
  }
}

ArrayXd transposed(const solver::Grid& grid, const ArrayXd& values) {
  ArrayXd turned(values.size());
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) turned[j * grid.n1 + i] = values[i * grid.n2 + j];
  }
  return turned;
}

/// Mean of x1^2 over mean of x2^2 under the pressure, about its centre.
double aspect(const ForeignField& field) {
  const auto variance = [&](const ArrayXd& x) {
    const double mean = (field.pressure * x).sum() / field.pressure.sum();
    return (field.pressure * (x - mean).square()).sum();
  };
  return variance(solver::cell_x1(field.grid)) / variance(solver::cell_x2(field.grid));
}

/// Only an elliptic contact along the axes tells.
void mend_axes(ForeignField& field, const solver::Model& model) {
  if (!model.hertz) return;
  const double ratio = model.hertz->semi_axis_1 / model.hertz->semi_axis_2;
  const double expected = 2.0 * std::log(ratio);
  const double found = std::log(aspect(field));
  if (!(std::abs(found + expected) < 0.5 * std::abs(found - expected))) return;
  field.notes.push_back(
      "axes look exchanged: the contact's long axis lies along the file's other coordinate");
  const solver::Grid from = field.grid;
  const Index cells = from.cells();
  field.grid = {from.n2, from.n1, from.h2, from.h1};
  std::swap(field.centre[0], field.centre[1]);
  const ArrayXd q1 = transposed(from, field.traction.head(cells));
  field.traction.head(cells) = transposed(from, field.traction.tail(cells));
  field.traction.tail(cells) = q1;
  for (ArrayXd* values : {&field.pressure, &field.pressure_rounding, &field.traction_rounding}) {
    *values = transposed(from, *values);
  }
}

/// A contact that stands a cell or more from its place in the scene is one in other coordinates.
void mend_origin(ForeignField& field, const solver::Scene& scene) {
  const bool has_axis = scene.surfaces.size() == 1 && solver::find_height_map(scene.surfaces) == nullptr &&
                        scene.surfaces.front().shape != solver::Shape::roughness;
  if (!has_axis) return;
  const double total = field.pressure.sum();
  std::array<double, 2> off{};
  for (std::size_t k = 0; k < 2; ++k) {
    const ArrayXd x = k == 0 ? solver::cell_x1(field.grid) : solver::cell_x2(field.grid);
    off[k] = field.centre[k] + (field.pressure * x).sum() / total - scene.surfaces.front().at[k];
  }
  if (std::abs(off[0]) < field.grid.h1 && std::abs(off[1]) < field.grid.h2) return;
  field.notes.push_back(fmt::format(
      "the contact's middle stands ({:.4g}, {:.4g}) m from the scene's: moved there", off[0], off[1]));
  for (std::size_t k = 0; k < 2; ++k) field.centre[k] -= off[k];
}

/// Components of the traction exchanged, then each times its sign.
struct Orientation {
  bool exchanged;
  double sign1;
  double sign2;

  ArrayXd of(const ArrayXd& traction) const {
    const Index cells = traction.size() / 2;
    ArrayXd turned(traction.size());
    turned.head(cells) = sign1 * (exchanged ? traction.tail(cells) : traction.head(cells));
    turned.tail(cells) = sign2 * (exchanged ? traction.head(cells) : traction.tail(cells));
    return turned;
  }

  std::string text() const {
    if (!exchanged && sign1 < 0.0 && sign2 < 0.0) {
      return "tractions look reversed (those on the other body, or a moment that turns the other way)";
    }
    std::string order = exchanged ? "q1 and q2 look exchanged" : "";
    const char* reversed = sign1 < 0.0 && sign2 < 0.0 ? "both" : sign1 < 0.0 ? "q1" : sign2 < 0.0 ? "q2" : "";
    if (*reversed == '\0') return order;
    const std::string sign = fmt::format("{} reversed", reversed);
    return exchanged ? fmt::format("{}, and then {}", order, sign)
                     : fmt::format("{} looks reversed", reversed);
  }
};

/// How far the tractions' loads are from the scene's, as parts of the limits.
class LoadMismatch {
 public:
  LoadMismatch(const ForeignField& field, const solver::Scene& scene, const OracleAnswer& exact)
      : load_(scene.steps.front()), friction_(scene.friction * field.pressure.sum()) {
    rotation_ = solver::rotation_field(field.grid);
    rotation_.head(field.grid.cells()) -= field.centre[1];
    rotation_.tail(field.grid.cells()) += field.centre[0];
    limit_ = solver::free_moment_limit(field.grid, scene.friction * field.pressure);
    const double area = field.grid.cell_area();
    const solver::TorsionLoad& torsion = load_.torsion;
    if (exact.oracle && std::isfinite(exact.oracle->moment)) {
      moment_ = exact.oracle->moment / area / limit_;
    } else if (torsion.moment) {
      moment_ = *torsion.moment / area / limit_;
    } else if (torsion.moment_ratio) {
      moment_ = *torsion.moment_ratio;
    } else {
      turns_ = std::copysign(*torsion.twist == 0.0 ? 0.0 : 1.0, *torsion.twist);
    }
    for (std::size_t k = 0; k < 2; ++k) force_[k] = load_.force[k] / area / friction_;
  }

  double operator()(const ArrayXd& traction) const {
    const Index cells = traction.size() / 2;
    const double moment = (traction * rotation_).sum();
    const double off =
        moment_ ? std::abs(moment / limit_ - *moment_)
                : std::abs(moment / (solver::norms(traction) * solver::norms(rotation_)).sum() - turns_);
    if (load_.displacement) return off;
    return off + std::hypot(traction.head(cells).sum() / friction_ - force_[0],
                            traction.tail(cells).sum() / friction_ - force_[1]);
  }

  /// Of no traction at all.
  double size() const {
    const double force = load_.displacement ? 0.0 : std::hypot(force_[0], force_[1]);
    return std::abs(moment_.value_or(turns_)) + force;
  }

 private:
  const solver::Step& load_;
  double friction_;  ///< all loads over the cell area
  double limit_ = 0.0;
  std::optional<double> moment_;
  double turns_ = 0.0;
  std::array<double, 2> force_{};
  ArrayXd rotation_;
};

/// Loads wrong by less than half stay what they are, an error of the field; else the orientation counts under
/// which they come closest.
void mend_orientation(ForeignField& field, const solver::Scene& scene, const OracleAnswer& exact) {
  const LoadMismatch mismatch(field, scene, exact);
  double least = 0.5 * mismatch.size();
  if (!(mismatch(field.traction) > least)) return;
  std::optional<Orientation> best;
  for (const bool exchanged : {false, true}) {
    for (const double sign1 : {1.0, -1.0}) {
      for (const double sign2 : {1.0, -1.0}) {
        const Orientation orientation{exchanged, sign1, sign2};
        const double off = mismatch(orientation.of(field.traction));
        if (!(off < least)) continue;
        least = off;
        best = orientation;
      }
    }
  }
  if (!best) return;
  field.traction = best->of(field.traction);
  field.notes.push_back(best->text() + ": only so do they carry the scene's loads");
}

/// Cells without pressure between cells that have some: rows that the file lacks, perhaps.
void note_holes(ForeignField& field) {
  const Index n2 = field.grid.n2;
  const ArrayXd& p = field.pressure;
  Index holes = 0;
  for (Index i = 1; i + 1 < field.grid.n1; ++i) {
    for (Index k = i * n2 + 1; k + 1 < (i + 1) * n2; ++k) {
      if (p[k] == 0.0 && p[k - 1] > 0.0 && p[k + 1] > 0.0 && p[k - n2] > 0.0 && p[k + n2] > 0.0) ++holes;
    }
  }
  if (holes > 0)
    field.notes.push_back(fmt::format("{} cells in the midst of the contact carry nothing", holes));
}

}  // namespace

ForeignField in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                const OracleAnswer& exact) {
  mend_length(field, scene, expected_width(model, exact));
  mend_stress(field, scene.steps.front());
  mend_axes(field, model);
  mend_origin(field, scene);
  mend_orientation(field, scene, exact);
  note_holes(field);
  return field;
}

}  // namespace slipstick::convergence
