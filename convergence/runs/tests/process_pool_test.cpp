#include "convergence/runs/process_pool.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/worker.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

const std::string kPaper = std::string(SLIPSTICK_SCENES) + "/paper.toml";
const std::string kCells = "grid.cells=[16,16]";

class ProcessPoolTest : public ScratchFolder {
 protected:
  ProcessPoolOptions options() const { return {.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM}; }

  /// The paper's scene, through steps of its moment.
  fs::path history(int most_iterations) const {
    const std::string most = std::to_string(most_iterations);
    const std::string bodies = read_text(kPaper).erase(read_text(kPaper).find("[load]"));
    return write("history-" + most + ".toml",
                 bodies + "[load]\nnormal = 1000.0\n[grid]\ncells = [16, 16]\n[solver]\nmax_iterations = " +
                     most + "\n[[step]]\nmoment_ratio = 0.8\n[[step]]\nmoment_ratio = -0.8\n");
  }
};

/// Names and places of all numbers and words.
std::vector<std::string> paths(const Json& result) {
  std::vector<std::string> found;
  const Json flat = result.flatten();
  for (const auto& [path, value] : flat.items()) found.push_back(path);
  return found;
}

/// The key holds the scene and each file that it reads, overrides, rounding, variant, and further output, so
/// that no stale answer is used.
TEST_F(ProcessPoolTest, AKeyHoldsAllThatAnAnswerDependsOn) {
  const std::string flat = "0,0,0\n0,0,0\n0,0,";
  write("heights.csv", flat + "0\n");
  const std::string body =
      "name='map'\n[upper]\nshape='height_map'\nfile='heights.csv'\nspacing=[1e-5,1e-5]\nunit='um'\n"
      "ends_at_grid_edge=true\nyoung_modulus=210e9\npoisson_ratio=0.3\n[lower]\nyoung_modulus=210e9\n"
      "poisson_ratio=0.3\n[contact]\nfriction=0.1\n[load]\nnormal=10.0\nmoment_ratio=0.5\n";
  const RunSpec spec{.scene = write("map.toml", body)};
  const std::string key = prepare_run(spec).cache_key;
  EXPECT_EQ(prepare_run(spec).cache_key, key);
  for (const auto& change : std::vector<std::function<void(RunSpec&)>>{
           [](RunSpec& other) { other.overrides = {"contact.friction=0.2"}; },
           [](RunSpec& other) { other.rounding = Rounding::upward; },
           [](RunSpec& other) { other.variant = Variant::exchanged; },
           [this](RunSpec& other) { other.fields = folder_ / "fields.csv"; },
           [](RunSpec& other) { other.profile = true; }}) {
    RunSpec other = spec;
    change(other);
    EXPECT_NE(prepare_run(other).cache_key, key);
  }
  write("heights.csv", flat + "0.001\n");
  EXPECT_NE(prepare_run(spec).cache_key, key) << "the heights are other ones";
  write("heights.csv", flat + "0\n");
  EXPECT_EQ(prepare_run(spec).cache_key, key);
  write("map.toml", body + "# another text\n");
  EXPECT_NE(prepare_run(spec).cache_key, key);
}

/// There is one way to solve a scene. Its steps decide whether the result has steps, whether the solve
/// reached them or not.
TEST_F(ProcessPoolTest, GivesWhatSolveGives) {
  for (const auto& [scene, status] : {std::pair<fs::path, std::string>{kPaper, "converged"},
                                      {history(5000), "converged"},
                                      {history(1), "not_converged"}}) {
    const Json pooled = to_json(ProcessPool(options()).run(RunSpec{scene, {kCells}}));
    const ProgramEnd solve = run_program({SLIPSTICK_PROGRAM, "solve", scene, "--set", kCells, "--json", "-"},
                                         {.captured = Captured::output});
    const Json solved = Json::parse(solve.output);
    EXPECT_EQ(paths(pooled), paths(solved));
    EXPECT_EQ(to_json(from_json(solved)).dump(), solved.dump());
    EXPECT_EQ(pooled["status"], status);
    EXPECT_EQ(pooled["twist_angle"], solved["twist_angle"]);
    EXPECT_EQ(pooled.contains("steps"), scene != kPaper);
    if (status == "not_converged") {
      EXPECT_EQ(pooled["history"]["steps"], 1);
    }
  }
}

/// A result without the times and the memory of the solve.
Json without_times(const SolveRecord& record) {
  const Json result = to_json(record);
  Json kept = Json::object();
  const Json flat = result.flatten();
  for (const auto& [path, value] : flat.items()) {
    const auto has = [&, whole = path + "/"](const char* key) {
      return whole.find(key) != std::string::npos;
    };
    if (!has("/seconds/") && !has("/provenance/") && !has("/peak_bytes/")) kept[path] = value;
  }
  return kept;
}

/// A worker solves many runs; a result does not depend on earlier ones. Equal runs are computed once.
TEST_F(ProcessPoolTest, ARunDoesNotDependOnThoseBeforeIt) {
  std::vector<RunSpec> specs{
      {.scene = kPaper, .overrides = {kCells}},
      {.scene = kPaper, .overrides = {kCells}, .rounding = Rounding::upward},
      {.scene = kPaper, .overrides = {kCells, "load.moment_ratio=0.3"}},
      {.scene = kPaper, .overrides = {kCells, "grid.extent=[1e-4,1e-4]"}},  // refused
      {.scene = kPaper, .overrides = {kCells, "load.moment_ratio=0.3"}, .variant = Variant::mirrored},
      {.scene = kPaper, .overrides = {kCells, "solver.cell_traction='smooth'"}},
      {.scene = history(5000)},
      {.scene = kPaper, .overrides = {kCells, "load.moment_ratio=0.9"}, .rounding = Rounding::downward},
      {.scene = kPaper, .overrides = {kCells, "load.moment_ratio=0.4"}},
      {.scene = kPaper, .overrides = {"grid.cells=[96,96]", "load.moment_ratio=0.5"}},
      {.scene = kPaper,
       .overrides = {"grid.cells=[96,96]", "load.moment_ratio=0.5"},
       .rounding = Rounding::downward},
      {.scene = kPaper, .overrides = {kCells, "solver.rounding_seed=7"}}};
  const auto different = static_cast<std::ptrdiff_t>(specs.size());
  specs.push_back(specs.front());
  ProcessPoolOptions together = options();
  together.jobs = 1;
  const std::vector<SolveRecord> results = ProcessPool(together).run(specs);
  for (std::size_t i = 0; i < specs.size(); ++i) {
    ProcessPoolOptions apart = options();
    apart.folder = folder_ / "apart" / std::to_string(i);
    EXPECT_EQ(without_times(results[i]), without_times(ProcessPool(apart).run(specs[i]))) << i;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(together.folder), {}), different);
}

TEST_F(ProcessPoolTest, ARefusedRunHasNoFieldsAndSaysWhy) {
  const RunSpec spec{
      .scene = kPaper, .overrides = {kCells, "grid.extent=[1e-4,1e-4]"}, .fields = folder_ / "none.csv"};
  const SolveRecord refused = ProcessPool(options()).run(spec);
  EXPECT_EQ(refused.status, RunStatus::refused);
  EXPECT_THAT(refused.message, testing::HasSubstr("grid.extent"));
  EXPECT_FALSE(fs::exists(spec.fields));
  const RunSpec misspelled{kPaper, {"load.moment_ration=0.5"}};
  EXPECT_THROW(ProcessPool(options()).run(misspelled), solver::InputError);
  const std::vector<SolveRecord> both = ProcessPool(options()).run_or_refuse({misspelled, spec});
  EXPECT_EQ(both[0].status, RunStatus::refused);
  EXPECT_EQ(both[1].message, refused.message);
}

TEST_F(ProcessPoolTest, ARunWithoutItsFieldsIsNotFinished) {
  RunSpec spec{.scene = kPaper, .overrides = {kCells}, .fields = folder_ / "fields.h5", .profile = true};
  const ProcessPool pool(options());
  const SolveRecord first = pool.run(spec);
  EXPECT_GT(fs::file_size(spec.fields), 1000U);
  EXPECT_FALSE(first.profile->empty());
  EXPECT_EQ(pool.run(spec).seconds(), first.seconds());  // no two runs take the same time
  const std::string fields = read_text(spec.fields);
  fs::resize_file(spec.fields, fields.size() / 2);
  const SolveRecord second = pool.run(spec);
  EXPECT_NE(second.seconds(), first.seconds()) << "half of its fields were there";
  EXPECT_EQ(second.end.loads.twist_angle.value, first.end.loads.twist_angle.value);
  EXPECT_TRUE(read_text(spec.fields) == fields);
  fs::remove(spec.fields);
  EXPECT_NE(pool.run(spec).seconds(), second.seconds());
  EXPECT_TRUE(read_text(spec.fields) == fields);
  spec.profile = false;
  EXPECT_FALSE(pool.run(spec).profile);
}

/// The message names the file that cannot be written; finished results stay.
TEST_F(ProcessPoolTest, StopsWhereAResultCannotBeWritten) {
  const ProcessPool pool(options());
  const RunSpec done{.scene = kPaper, .overrides = {kCells}};
  const SolveRecord first = pool.run(done);
  const auto complaint = [&](const RunSpec& spec) -> std::string {
    try {
      pool.run(spec);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const fs::path lost = folder_ / "no/such/folder/fields.h5";
  EXPECT_THAT(complaint({.scene = kPaper, .overrides = {kCells}, .fields = lost}),
              testing::AllOf(testing::HasSubstr(lost.string() + ": cannot be written"),
                             testing::HasSubstr("the same command goes on from there")));
  const RunSpec blocked{.scene = kPaper, .overrides = {"grid.cells=[12,12]"}};
  const fs::path point = folder_ / "points" / (prepare_run(blocked).name + ".json");
  fs::create_directories(point / "in the way");
  EXPECT_EQ(complaint(blocked), "") << "a folder in a result's place is put aside";
  EXPECT_TRUE(fs::is_regular_file(point));
  EXPECT_EQ(pool.run(done).seconds(), first.seconds()) << "it was solved again";
}

/// Two programs share a folder: one that computes what the other has finished does not take it away.
TEST_F(ProcessPoolTest, AFinishedResultStaysWhileAnotherProgramComputesIt) {
  const RunSpec slow{.scene = kPaper, .overrides = {"grid.cells=[256,256]", "solver.operator=\"direct\""}};
  const PreparedRun run = prepare_run(slow);
  const ResultCache cache(folder_ / "points", SLIPSTICK_PROGRAM);
  cache.keep(run.name, run.cache_key, {{"status", "converged"}});
  {
    Worker other(SLIPSTICK_PROGRAM, folder_ / "points", {});
    other.start(slow);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  EXPECT_TRUE(cache.find(run.name, run.cache_key).has_value());
}

TEST_F(ProcessPoolTest, LeavesOtherChildrenOfThisProcessAlone) {
  const pid_t other = fork();
  if (other == 0) _exit(3);
  EXPECT_TRUE(ProcessPool(options()).run(RunSpec{kPaper, {kCells}}).is_converged());
  int status = 0;
  EXPECT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

void handle(int) {}

/// A library does not change its host's signal handlers; the host stops it by a callback.
TEST_F(ProcessPoolTest, StopsWhereItsHostSaysSo) {
  const auto before = std::signal(SIGINT, handle);
  ProcessPoolOptions stopping = options();
  static bool untouched = false;
  stopping.interrupted = [] {
    struct sigaction now {};
    sigaction(SIGINT, nullptr, &now);
    untouched = now.sa_handler == handle;
    return true;
  };
  EXPECT_THROW(ProcessPool(stopping).run(RunSpec{kPaper, {"grid.cells=[256,256]", "solver.operator=direct"}}),
               std::runtime_error);
  EXPECT_TRUE(untouched);
  std::signal(SIGINT, before);
  EXPECT_TRUE(fs::is_empty(folder_ / "points"));
}

}  // namespace
}  // namespace slipstick::convergence
