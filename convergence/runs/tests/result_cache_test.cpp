#include "convergence/runs/result_cache.hpp"

#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "convergence/runs/run_spec.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

class ResultCacheTest : public ScratchFolder {
 protected:
  int computed_ = 0;
  Json ask(const std::string& cache_key) {
    const ResultCache cache(folder_);
    if (std::optional<Json> found = cache.find("point", cache_key)) return *std::move(found);
    ++computed_;
    const Json result{{"value", 0.1}};
    cache.keep("point", cache_key, result);
    return result;
  }
};

TEST_F(ResultCacheTest, AnotherKeyIsComputed) {
  ask("a");
  ask("b");
  EXPECT_EQ(computed_, 2);
}

/// Whatever lies where a result was kept, it is computed again, and kept.
TEST_F(ResultCacheTest, ADamagedPointIsComputedAgain) {
  const fs::path point = folder_ / "point.json";
  ask("a");
  const std::string good = file_text(point);
  const auto of_wrong_kind = [&](const char* key, const Json& value) {
    Json json = Json::parse(good);
    json[key] = value;
    return json.dump();
  };
  std::string flipped = good;
  flipped.replace(flipped.find("0.1"), 3, "0.2");
  for (const std::string& bad :
       {std::string(), good.substr(0, good.size() / 2), std::string("\x7f\0\xff", 3), flipped,
        std::string("[1, 2]"), std::string("3"), of_wrong_kind("program", 3),
        of_wrong_kind("cache_key", nullptr), of_wrong_kind("result", nullptr),
        of_wrong_kind("result", "text"), of_wrong_kind("result", Json::object()),
        of_wrong_kind("checksum", 3), std::string(100'000, '[')}) {
    std::ofstream(point) << bad;
    computed_ = 0;
    EXPECT_EQ(ask("a")["value"], 0.1);
    EXPECT_EQ(ask("a")["value"], 0.1);
    EXPECT_EQ(computed_, 1) << bad.substr(0, 80);
  }
}

/// A pipe is not read, and no result is written through a link.
TEST_F(ResultCacheTest, WhatIsNoFileIsReplaced) {
  const fs::path point = folder_ / "point.json";
  const std::vector<std::function<void()>> others{
      [&] { fs::create_directory(point); }, [&] { ASSERT_EQ(mkfifo(point.c_str(), 0600), 0); },
      [&] { fs::create_symlink("/dev/null", point); }, [&] { fs::create_symlink("nowhere", point); }};
  for (const auto& put : others) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    put();
    computed_ = 0;
    ask("a");
    ask("a");
    EXPECT_EQ(computed_, 1);
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(point)));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  }
}

/// A file that belongs to a result has to be the one that was there when it was kept.
TEST_F(ResultCacheTest, IsNotFinishedWithoutWhatLiesBeside) {
  const fs::path beside = folder_ / "fields.h5";
  const ResultCache cache(folder_);
  const auto finished = [&] { return cache.find("point", "a", beside).has_value(); };
  write("fields.h5", "all of it");
  cache.keep("point", "a", {{"value", 0.1}}, beside);
  EXPECT_TRUE(finished());
  for (const char* damaged : {"all", "", "all of ix"}) {
    write("fields.h5", damaged);
    EXPECT_FALSE(finished()) << damaged;
  }
  fs::remove(beside);
  EXPECT_FALSE(finished());
  write("fields.h5", "all of it");
  EXPECT_TRUE(finished());
}

TEST_F(ResultCacheTest, AnotherProgramComputesAgain) {
  ask("a");
  EXPECT_TRUE(ResultCache(folder_).find("point", "a").has_value());
  EXPECT_FALSE(ResultCache(folder_, SLIPSTICK_PROGRAM).find("point", "a").has_value());
}

// A cache key holds the scene's name and whole tables, which need not be UTF-8; JSON must be.
TEST_F(ResultCacheTest, ResultsOfScenesWithAnyNameAreFoundAgain) {
  const PreparedRun run = prepare_run({.scene = write("caf\xe9.toml", solver::kShortScene)});
  const ResultCache cache(folder_ / "runs");
  cache.keep(run.name, run.cache_key, Json{{"name", "caf\xe9"}});
  EXPECT_TRUE(cache.find(run.name, run.cache_key).has_value());
}

}  // namespace
}  // namespace slipstick::convergence
