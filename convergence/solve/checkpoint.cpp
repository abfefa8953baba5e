#include "convergence/solve/checkpoint.hpp"

#include <fmt/core.h>

#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/results/json_text.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/system/machine.hpp"
#include "solver/history/history_state.hpp"
#include "solver/input/datasets.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using namespace solver;

constexpr const char* kFormat = "slipstick history 3";
/// Largest part of the time spent on writing.
constexpr double kWritingPart = 0.01;
/// Limit on the values of a dataset: twice the cells of the largest grid that is solved.
constexpr Eigen::Index kMaxValues = Eigen::Index{1} << 33;

/// Visits each number of a state, always in the same order. Its fields are datasets of their own.
template <typename State, typename Visit>
void visit_numbers(State& state, Visit&& visit) {
  const auto all = [&](auto&... numbers) { (visit(numbers), ...); };
  auto& normal = state.contact.normal;
  auto& motion = state.contact.motion;
  auto& safeguards = normal.safeguards;
  auto& end = state.end;
  auto& open = state.open;
  all(state.finished, state.contact.energy, motion.delta1, motion.delta2, motion.twist);
  all(normal.approach, normal.complementarity, normal.load_error, normal.iterations);
  all(safeguards.second_solves, safeguards.halvings, safeguards.gradient_steps, safeguards.breakdowns);
  all(end.twist_angle, end.displacement[0], end.displacement[1], end.moment, end.force[0], end.force[1]);
  all(end.moment_limit);
  all(open.worst, open.last_twist);
  for (auto* const sizes :
       {&open.sum, &open.largest, &open.small_stick, &open.largest_small_stick, &open.last_small_stick}) {
    for (const auto number : solver::kQuantities) visit(sizes->*number);
  }
  for (auto& grid : normal.grids) all(grid.n1, grid.n2, grid.applications, grid.iterations, grid.gap);
}

/// A checksum of the bits of all numbers and of the text, which detects a changed file.
std::string sum_of(const ContactState& contact, const std::string& text) {
  std::uint64_t sum = checksum(text);
  for (const Eigen::ArrayXd* const field : {&contact.normal.pressure, &contact.traction, &contact.slip}) {
    for (const double value : *field) sum = checksum_of_word(std::bit_cast<std::uint64_t>(value), sum);
  }
  return fmt::format("{:016x}", sum);
}

std::string as_text(const Eigen::ArrayXd& bytes) {
  std::string text;
  for (const double byte : bytes) text += static_cast<char>(static_cast<unsigned char>(byte));
  return text;
}

Eigen::ArrayXd numbers_in(const std::filesystem::path& file, const std::string& name) {
  return solver::read_datasets(file, {name}, 1, kMaxValues).front().reshaped();
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path file, const PreparedRun& run)
    : file_(std::move(file)), scene_(run.name), program_(file_identity(own_program())) {}

std::shared_ptr<const FinishedSteps> Checkpoint::read() const {
  if (!std::filesystem::exists(file_)) return nullptr;
  const std::string text = as_text(numbers_in(file_, "history"));
  const std::string allowed = "one that --checkpoint wrote, or another file, to begin at the first step";
  const InputError damaged(file_.string(), "is no whole checkpoint; allowed: " + allowed);
  const Json json = parse_json(text, file_.string(), allowed);
  if (!json.is_object() || json.value("format", "") != kFormat) throw damaged;
  if (json.value("scene", "") != scene_) {
    throw InputError(file_.string(),
                     "is the checkpoint of another scene, or of this one with other keys, --set "
                     "or input files; allowed: the same, or another file, to begin at the first "
                     "step");
  }
  if (json.value("program", "") != program_) {
    throw InputError(file_.string(),
                     "is the checkpoint of another build of slipstick, whose digits may differ; "
                     "allowed: that build, or another file, to begin at the first step");
  }
  HistoryState state;
  std::vector<StepRecord> steps;
  try {
    NormalSolution& normal = state.contact.normal;
    normal.pressure = numbers_in(file_, "pressure");
    state.contact.traction = numbers_in(file_, "traction");
    if (json.at("has_slip").get<bool>()) state.contact.slip = numbers_in(file_, "slip");
    if (as_text(numbers_in(file_, "checksum")) != sum_of(state.contact, text)) throw damaged;
    normal.status = json.at("converged").get<bool>() ? Status::converged : Status::not_converged;
    normal.message = json.at("message");
    normal.safeguards.breakdown = json.at("breakdown");
    normal.grids.resize(json.at("grids"));
    const Json& numbers = json.at("numbers");
    visit_numbers(state, [&, next = std::size_t{0}]<typename T>(T& number) mutable {
      const Json& at = numbers.at(next++);
      // Infinite numbers are null in JSON.
      number = static_cast<T>(at.is_null() ? std::numeric_limits<double>::infinity() : at.get<double>());
    });
    for (const Json& step : json.at("steps")) steps.push_back(step_from_json(step));
  } catch (const Json::exception&) {
    throw damaged;
  }
  return std::make_shared<const FinishedSteps>(
      FinishedSteps{std::make_shared<const HistoryState>(std::move(state)), std::move(steps)});
}

void Checkpoint::write(const HistoryState& state, const std::vector<StepRecord>& steps) const {
  Json steps_json = Json::array();
  for (const StepRecord& step : steps) steps_json.push_back(to_json(step));
  const ContactState& contact = state.contact;
  Json numbers = Json::array();
  visit_numbers(state, [&](const auto& number) { numbers.push_back(static_cast<double>(number)); });
  const std::string text = json_text({{"format", kFormat},
                                      {"scene", scene_},
                                      {"program", program_},
                                      {"converged", contact.normal.status == Status::converged},
                                      {"message", contact.normal.message},
                                      {"breakdown", contact.normal.safeguards.breakdown},
                                      {"grids", contact.normal.grids.size()},
                                      {"numbers", std::move(numbers)},
                                      {"has_slip", contact.slip.size() > 0},
                                      {"steps", std::move(steps_json)}});
  std::vector<solver::Column> columns{{"pressure", contact.normal.pressure}, {"traction", contact.traction}};
  if (contact.slip.size() > 0) columns.push_back({"slip", contact.slip});
  write_datasets(file_, columns, {{"history", text}, {"checksum", sum_of(contact, text)}});
}

void Checkpoint::offer(const HistoryState& state, const std::vector<StepRecord>& steps) {
  const auto start = Clock::now();
  if (written_ != Clock::time_point{} && kWritingPart * (start - written_) < took_) return;
  write(state, steps);
  written_ = Clock::now();
  took_ = written_ - start;
}

}  // namespace slipstick::convergence
