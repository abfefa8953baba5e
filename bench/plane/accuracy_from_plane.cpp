#include "bench/plane/accuracy_from_plane.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <ranges>
#include <stdexcept>
#include <vector>

namespace slipstick::bench {
namespace {

using convergence::AccuracyData;
using convergence::MeasuredMesh;

/// Part of the mesh's error that the iteration may change.
constexpr double kIterationPart = 0.1;

/// Points of one mesh and load by tolerance, tightest first.
using ByTolerance = std::map<double, const Json*>;
/// The loads of one mesh.
using Loads = std::vector<ByTolerance>;

bool has_default_choices(const Json& point) {
  static const PlaneChoice usual;
  return std::ranges::all_of(kChoiceKeys,
                             [&](const ChoiceKey& key) { return point[key.name] == usual.*key.word; });
}

/// By cells along a side; meshes that were solved at every load.
std::map<double, Loads> timed_meshes(const Json& plane) {
  std::map<double, Loads> meshes;
  for (const Json& scene : plane["scenes"]) {
    std::map<double, ByTolerance> of_load;
    for (const Json& point : scene["points"]) {
      if (!has_default_choices(point) || !point["seconds"].is_object()) continue;
      of_load[point["cells"]][point["tolerance"]] = &point;
    }
    for (auto& [cells, points] : of_load) meshes[cells].push_back(std::move(points));
  }
  std::erase_if(meshes, [&](const auto& mesh) { return mesh.second.size() < plane["scenes"].size(); });
  return meshes;
}

/// The plane's name of an accuracy's quantity.
std::string plane_quantity(const std::string& word) { return word == "traction" ? "traction_l2" : word; }

/// Root mean square, over the grids, of the iteration's change.
double iteration_error(const Json& loose, const Json& tight) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loose.size(); ++i) {
    const double change = loose[i].get<double>() - tight[i].get<double>();
    sum += change * change;
  }
  return std::sqrt(sum / static_cast<double>(loose.size()));
}

double largest_error(const Loads& loads, const std::string& quantity) {
  const auto error = [&](const ByTolerance& points) {
    return points.begin()->second->at("error").at(quantity).get<double>();
  };
  return std::ranges::max(loads | std::views::transform(error));
}

/// Tolerances, falling, at which all loads were solved.
std::vector<double> shared_tolerances(const Loads& loads) {
  std::vector<double> shared;
  for (auto it = loads.front().rbegin(); it != loads.front().rend(); ++it) {
    const auto has_it = [&](const ByTolerance& points) { return points.contains(it->first); };
    if (std::ranges::all_of(loads, has_it)) shared.push_back(it->first);
  }
  return shared;
}

/// The loosest tolerance at which, and below, the iteration changes no load's error by more than this.
double loosest_tolerance(const Loads& loads, const std::string& quantity, double most_change) {
  double loosest = 0.0;
  const std::vector<double> tolerances = shared_tolerances(loads);
  for (auto tolerance = tolerances.rbegin(); tolerance != tolerances.rend(); ++tolerance) {
    for (const ByTolerance& points : loads) {
      const Json& tight = points.begin()->second->at("errors").at(quantity);
      const Json& loose = points.at(*tolerance)->at("errors").at(quantity);
      if (!(iteration_error(loose, tight) <= most_change)) return loosest;
    }
    loosest = *tolerance;
  }
  return loosest;
}

void add_costs(MeasuredMesh& mesh, const Loads& loads, double application_seconds) {
  for (const double tolerance : shared_tolerances(loads)) {
    double applications = 0.0;
    double seconds = 0.0;
    for (const ByTolerance& points : loads) {
      const Json& point = *points.at(tolerance);
      applications = std::max(applications, point["applications"].get<double>());
      seconds = std::max(seconds, point["seconds"]["median"].get<double>());
    }
    mesh.tolerances.push_back(tolerance);
    mesh.applications.push_back(applications);
    mesh.work.push_back(seconds / application_seconds);
  }
}

MeasuredMesh measured_mesh(const Loads& loads, double application_seconds) {
  MeasuredMesh mesh{};
  mesh.cells_across = loads.front().begin()->second->at("contact_cells").get<double>();
  for (const auto& [word, of] : convergence::accuracy_words()) {
    const double error = largest_error(loads, plane_quantity(word));
    mesh.errors[static_cast<std::size_t>(of)] = {
        error, loosest_tolerance(loads, plane_quantity(word), kIterationPart * error)};
  }
  add_costs(mesh, loads, application_seconds);
  return mesh;
}

/// Makes errors fall and tolerances tighten from mesh to finer mesh.
void make_monotone(std::vector<MeasuredMesh>& meshes) {
  for (std::size_t q = 0; q < convergence::kAccuracies; ++q) {
    for (std::size_t i = meshes.size() - 1; i > 0; --i) {
      meshes[i - 1].errors[q].error = std::max(meshes[i - 1].errors[q].error, meshes[i].errors[q].error);
    }
    for (std::size_t i = 1; i < meshes.size(); ++i) {
      meshes[i].errors[q].tolerance =
          std::min(meshes[i].errors[q].tolerance, meshes[i - 1].errors[q].tolerance);
    }
  }
}

}  // namespace

AccuracyData accuracy_from_plane(const Json& plane) {
  AccuracyData data;
  for (const auto& [cells, loads] : timed_meshes(plane)) {
    if (shared_tolerances(loads).empty()) continue;
    data.meshes.push_back(measured_mesh(loads, plane["application_seconds"].get<double>()));
  }
  if (data.meshes.size() < 2) throw std::runtime_error("the plane holds too few meshes to pick by");
  make_monotone(data.meshes);
  return data;
}

}  // namespace slipstick::bench
