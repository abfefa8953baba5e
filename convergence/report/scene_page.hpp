#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/report/scene_verdict.hpp"
#include "convergence/runs/process_pool.hpp"

/// The page of any scene: description, answer, orders of convergence, error against time, hard cases; for the
/// paper's scene also the paper's validation.
namespace slipstick::convergence {

/// The input of a page.
struct PageRequest {
  RunSpec base;  ///< the scene; overrides may name a program that solves it
  PageSize size;
  std::vector<WantedError> wanted = {};
  std::vector<std::string> uncertain = {};    ///< as uncertain_inputs() takes them
  std::vector<BesideMethod> beside = {};      ///< programs to compare with
  std::optional<Validation> validation = {};  ///< of the paper, for the page of its scene
};

/// The stages of scene_page(). scene: its name on a line of progress; empty: it is the only one.
std::vector<Stage> page_stages(const PageRequest& request, const std::string& scene);

/// Solves all that the page shows and judges it, then writes report.json and answer.h5 or .csv (the fields on
/// the finest mesh) to the folder.
///   1. The answer on its meshes; studies of meshes and tolerances; each number with its error.
///   2. Error against time; equivalent scenes, coarse meshes and extreme loads; digits left by rounding.
///   3. The paper's validation, if it is requested.
///   4. The headline: findings and changes since the page that was in the folder.
/// Throws InputError for a scene that cannot be read and for a quantity of `wanted` that the result does not
/// have; std::runtime_error where the scene itself has no answer, and as the pool does.
Page scene_page(const PageRequest& request, const std::filesystem::path& folder, const ProcessPool& pool);

}  // namespace slipstick::convergence
