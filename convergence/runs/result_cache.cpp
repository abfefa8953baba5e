#include "convergence/runs/result_cache.hpp"

#include <fmt/core.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/results/whole_file.hpp"

namespace slipstick::convergence {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string identify(const fs::path& program) {
  std::error_code error;
  const auto written = fs::last_write_time(program, error);
  if (error) return "unknown program";
  return fmt::format("{} bytes, written {}", fs::file_size(program), written.time_since_epoch().count());
}

}  // namespace

void write_json_file(const fs::path& file, const Json& json) {
  // Names of files need not be UTF-8; JSON is.
  const std::string content = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::ifstream old(file);
  if (old && fs::is_regular_file(file) && std::string(std::istreambuf_iterator<char>(old), {}) == content)
    return;
  write_whole_file(file, content);
}

ResultCache::ResultCache(fs::path folder, const fs::path& program)
    : folder_(std::move(folder)), program_(identify(program)) {
  fs::create_directories(folder_);
}

std::optional<Json> ResultCache::find(const std::string& name, const std::string& cache_key) const {
  std::ifstream stream(file(name));
  const Json found = stream && fs::is_regular_file(file(name)) ? Json::parse(stream, nullptr, false) : Json();
  const bool finished = found.is_object() && found.value("program", "") == program_ &&
                        found.value("cache_key", "") == cache_key && found.contains("result");
  return finished ? std::optional(found["result"]) : std::nullopt;
}

void ResultCache::keep(const std::string& name, const std::string& cache_key, const Json& result) const {
  write_json_file(file(name), {{"program", program_}, {"cache_key", cache_key}, {"result", result}});
}

void ResultCache::forget(const std::string& name) const {
  if (fs::is_regular_file(file(name))) fs::remove(file(name));
}

Json ResultCache::find_or_compute(const std::string& name, const std::string& cache_key,
                                  const std::function<Json()>& compute) const {
  if (std::optional<Json> found = find(name, cache_key)) return *std::move(found);
  Json result = compute();
  keep(name, cache_key, result);
  return result;
}

}  // namespace slipstick::convergence
