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
#include "solver/input/dataset_reader.hpp"
#include "solver/input/dataset_writer.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using namespace solver;

constexpr const char* kFormat = "slipstick history 2";
/// Largest part of the time spent on writing.
constexpr double kWritingPart = 0.01;
/// Limit on the values of a dataset: twice the cells of the largest grid that is solved.
constexpr Eigen::Index kMaxValues = Eigen::Index{1} << 33;

Json normal_json(const NormalSolution& normal) {
  Json grids = Json::array();
  for (const solver::GridWork& at : normal.grids) {
    grids.push_back({at.n1, at.n2, at.applications, at.iterations, at.gap});
  }
  const solver::Safeguards& safeguards = normal.safeguards;
  return {{"converged", normal.status == solver::Status::converged},
          {"message", normal.message},
          {"approach", normal.approach},
          {"complementarity", normal.complementarity},
          {"load_error", normal.load_error},
          {"iterations", normal.iterations},
          {"grids", std::move(grids)},
          {"safeguards",
           {safeguards.second_solves, safeguards.halvings, safeguards.gradient_steps, safeguards.breakdowns,
            safeguards.breakdown}}};
}

NormalSolution normal_of(const Json& json) {
  NormalSolution normal;
  normal.status =
      json.at("converged").get<bool>() ? solver::Status::converged : solver::Status::not_converged;
  normal.message = json.at("message");
  normal.approach = json.at("approach");
  normal.complementarity = json.at("complementarity");
  normal.load_error = json.at("load_error");
  normal.iterations = json.at("iterations");
  for (const Json& at : json.at("grids")) {
    normal.grids.push_back({at.at(0), at.at(1), at.at(2), at.at(3), at.at(4)});
  }
  const Json& safeguards = json.at("safeguards");
  normal.safeguards = {safeguards.at(0), safeguards.at(1), safeguards.at(2), safeguards.at(3),
                       safeguards.at(4)};
  return normal;
}

Json end_json(const solver::StepEnd& end) {
  return {end.twist,    end.displacement[0], end.displacement[1], end.moment,
          end.force[0], end.force[1],        end.moment_limit};
}

Json open_json(const solver::OpenHistory& open) {
  Json json{open.worst, open.last_twist};
  for (const auto& sizes :
       {open.sum, open.largest, open.small_stick, open.largest_small_stick, open.last_small_stick}) {
    for (const auto number : solver::kQuantities) json.push_back(sizes.*number);
  }
  return json;
}

/// Infinite numbers are null in JSON.
std::vector<double> numbers_of(const Json& json) {
  std::vector<double> numbers;
  for (const Json& at : json) {
    numbers.push_back(at.is_null() ? std::numeric_limits<double>::infinity() : at.get<double>());
  }
  return numbers;
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
    state.contact.normal = normal_of(json.at("normal"));
    state.contact.normal.pressure = numbers_in(file_, "pressure");
    state.contact.traction = numbers_in(file_, "traction");
    if (json.at("has_slip").get<bool>()) state.contact.slip = numbers_in(file_, "slip");
    if (as_text(numbers_in(file_, "checksum")) != sum_of(state.contact, text)) throw damaged;
    const Json& motion = json.at("motion");
    state.contact.motion = {motion.at(0), motion.at(1), motion.at(2)};
    const std::vector<double> end = numbers_of(json.at("end"));
    state.end = {end.at(0), {end.at(1), end.at(2)}, end.at(3), {end.at(4), end.at(5)}, end.at(6)};
    const std::vector<double> open = numbers_of(json.at("open"));
    solver::OpenHistory& at = state.open;
    at.worst = open.at(0);
    at.last_twist = open.at(1);
    std::size_t next = 2;
    for (auto* const sizes :
         {&at.sum, &at.largest, &at.small_stick, &at.largest_small_stick, &at.last_small_stick}) {
      for (const auto number : solver::kQuantities) sizes->*number = open.at(next++);
    }
    state.contact.energy = json.at("energy");
    state.finished = json.at("finished");
    for (const Json& step : json.at("steps")) steps.push_back(step_from_json(step));
  } catch (const Json::exception&) {
    throw damaged;
  } catch (const std::out_of_range&) {
    throw damaged;
  }
  return std::make_shared<const FinishedSteps>(
      FinishedSteps{std::make_shared<const HistoryState>(std::move(state)), std::move(steps)});
}

void Checkpoint::write(const HistoryState& state, const std::vector<StepRecord>& steps) const {
  Json steps_json = Json::array();
  for (const StepRecord& step : steps) steps_json.push_back(to_json(step));
  const ContactState& contact = state.contact;
  const std::string text =
      json_text({{"format", kFormat},
                 {"scene", scene_},
                 {"program", program_},
                 {"finished", state.finished},
                 {"motion", {contact.motion.delta1, contact.motion.delta2, contact.motion.twist}},
                 {"end", end_json(state.end)},
                 {"open", open_json(state.open)},
                 {"energy", contact.energy},
                 {"normal", normal_json(contact.normal)},
                 {"has_slip", contact.slip.size() > 0},
                 {"steps", std::move(steps_json)}});
  std::vector<solver::Column> columns{{"pressure", contact.normal.pressure}, {"traction", contact.traction}};
  if (contact.slip.size() > 0) columns.push_back({"slip", contact.slip});
  write_datasets(file_, columns, {{"history", text}, {"checksum", sum_of(contact, text)}});
}

void PacedCheckpoint::offer(const HistoryState& state, const std::vector<StepRecord>& steps) {
  const auto start = Clock::now();
  if (written_ != Clock::time_point{} && kWritingPart * (start - written_) < took_) return;
  checkpoint_.write(state, steps);
  written_ = Clock::now();
  took_ = written_ - start;
}

}  // namespace slipstick::convergence
