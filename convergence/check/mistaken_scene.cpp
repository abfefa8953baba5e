#include "convergence/check/mistaken_scene.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Material;
using solver::Scene;

/// Cells of a field up to which some dozen scenes are solved: a second or two of work.
constexpr double kQuickCells = 128.0 * 128.0;

struct Body {
  Material Scene::*member;
  const char* name;
};
constexpr std::array<Body, 2> kBodies{{{&Scene::lower, "lower"}, {&Scene::upper, "upper"}}};

/// How far a field's pressure is from that of another scene.
double off_from(const Examination& e, const Scene& scene) {
  try {
    const solver::Model model = solver::make_model(scene);
    const GivenContact contact = make_given_contact(e.read.field, model, model.threads);
    const auto right = find_scene_pressure(contact, scene, model);
    return right ? right->off : std::numeric_limits<double>::infinity();
  } catch (const solver::InputError&) {  // no scene that can be solved
    return std::numeric_limits<double>::infinity();
  }
}

struct Mistake {
  std::string name;
  Scene scene;
};

/// Scenes with one mistake each.
std::vector<Mistake> mistakes_of(const Scene& scene) {
  std::vector<Mistake> mistakes;
  const auto add = [&](const std::string& name, const auto& change) {
    Mistake mistake{name, scene};
    change(mistake.scene);
    mistakes.push_back(std::move(mistake));
  };
  for (const Body& each : kBodies) {
    const auto member = each.member;
    const Material& body = scene.*member;
    if (!std::isinf(body.young_modulus)) {
      add("the compliance of one body only", [&](Scene& s) {
        s.*member = {std::numeric_limits<double>::infinity(), 0.0};
      });
    }
    if (!body.coating) continue;
    add(fmt::format("the layer on the {} body ignored", each.name),
        [&](Scene& s) { (s.*member).coating.reset(); });
    add(fmt::format("the constants of the {} body and its layer exchanged", each.name), [&](Scene& s) {
      Material& other = s.*member;
      std::swap(other.young_modulus, other.coating->young_modulus);
      std::swap(other.poisson_ratio, other.coating->poisson_ratio);
    });
  }
  if (is_coated(scene))
    add("the layer on the other body", [](Scene& s) { std::swap(s.upper.coating, s.lower.coating); });
  if (scene.layer.kind != nullptr)
    add("the layer between the bodies ignored", [](Scene& s) { s.layer = {}; });
  for (const double factor : {2.0, 0.5}) {
    const char* const name = factor > 1.0 ? "half" : "twice";
    add(fmt::format("{} the compliance of the pair", name), [&](Scene& s) {
      for (const Body& body : kBodies) (s.*body.member).young_modulus *= factor;
    });
    if (scene.surfaces.size() == 1 && scene.surfaces.front().shape == solver::Shape::sphere)
      add(fmt::format("{} the radius", name), [&](Scene& s) { s.surfaces.front().radius /= factor; });
  }
  return mistakes;
}

/// The factor within 1/kWidest and kWidest under which a changed scene is nearest, by golden sections of its
/// logarithm.
std::pair<double, double> nearest_factor(const std::function<double(double)>& off) {
  constexpr double kWidest = 8.0;
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSections = 14;
  double low = -std::log(kWidest);
  double high = std::log(kWidest);
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double at_left = off(std::exp(left));
  double at_right = off(std::exp(right));
  for (int i = 0; i < kSections; ++i) {
    if (at_left < at_right) {
      high = std::exchange(right, left);
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = off(std::exp(left));
    } else {
      low = std::exchange(left, right);
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = off(std::exp(right));
    }
  }
  return at_left < at_right ? std::pair{std::exp(left), at_left} : std::pair{std::exp(right), at_right};
}

std::optional<std::string> fitted_mistake(const Examination& e, double allowed) {
  for (const auto& [member, name] : kBodies) {
    if (!(e.scene.*member).coating) continue;
    const double thickness = (e.scene.*member).coating->thickness;
    const auto [factor, off] = nearest_factor([&, of = member](double times) {
      Scene scene = e.scene;
      (scene.*of).coating->thickness *= times;
      return off_from(e, scene);
    });
    if (off <= allowed) {
      return fmt::format("a layer of {:.3g} m in place of {:.4g} m on the {} body", factor * thickness,
                         thickness, name);
    }
  }
  const auto [factor, off] = nearest_factor([&](double times) {
    Scene scene = e.scene;
    for (const Body& body : kBodies) {
      Material& material = scene.*body.member;
      material.young_modulus *= times;
      if (material.coating) material.coating->young_modulus *= times;
    }
    return off_from(e, scene);
  });
  if (!(off <= allowed)) return std::nullopt;
  return fmt::format("elastic moduli {:.3g} times those of the scene", factor);
}

}  // namespace

std::optional<std::string> mistaken_scene(const Examination& e, double allowed) {
  const bool solved = e.reference.pressure && e.scene.pressure != solver::PressureModel::file;
  if (!solved || static_cast<double>(e.contact.grid.cells()) > kQuickCells) return std::nullopt;
  std::vector<std::string> names;
  for (const Mistake& mistake : mistakes_of(e.scene)) {
    const bool known = std::ranges::find(names, mistake.name) != names.end();
    if (!known && off_from(e, mistake.scene) <= allowed) names.push_back(mistake.name);
  }
  if (!names.empty()) return fmt::format("{}", fmt::join(names, ", or "));
  return fitted_mistake(e, allowed);
}

std::optional<std::string> lost_rows(const Examination& e, double allowed) {
  constexpr double kCarriesSomething = 0.05;  // of the largest pressure: no edge of any right field
  if (!e.reference.pressure) return std::nullopt;
  const ArrayXd& right = e.reference.pressure->values;
  const ArrayXd& found = e.contact.pressure;
  const ArrayXd there = (found > 0.0).cast<double>();
  const auto lost = ((found == 0.0) && (right > kCarriesSomething * right.maxCoeff())).count();
  const double off = (there * (found - right).abs()).sum() / (there * right).sum();
  if (lost == 0 || !(off <= allowed)) return std::nullopt;
  return fmt::format("a file that has lost rows: {} cells under the scene's pressure have none", lost);
}

}  // namespace slipstick::convergence
