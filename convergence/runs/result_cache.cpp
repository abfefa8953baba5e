#include "convergence/runs/result_cache.hpp"

#include <fmt/core.h>

#include <bit>
#include <fstream>
#include <ios>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>
#include <vector>

#include "convergence/results/json_text.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPrime = 1099511628211ULL;

/// The JSON of a kept result; its `checksum` is over all other keys.
Json entry(const std::string& program, const std::string& cache_key, const Json& result, const fs::path& beside) {
  Json kept{{"program", program}, {"cache_key", cache_key}, {"result", result}};
  if (!beside.empty()) kept["beside"] = file_identity(beside);
  kept["checksum"] = fmt::format("{:016x}", checksum(json_text(kept)));
  return kept;
}

}  // namespace

std::uint64_t checksum(std::string_view bytes, std::uint64_t of_before) {
  for (const char byte : bytes) of_before = (of_before ^ static_cast<unsigned char>(byte)) * kPrime;
  return of_before;
}

std::uint64_t checksum_of_word(std::uint64_t word, std::uint64_t of_before) {
  return (std::rotl(of_before, 31) ^ word) * kPrime;
}

std::string file_identity(const fs::path& file) {
  std::error_code error;
  std::ifstream stream;
  if (fs::is_regular_file(file, error)) stream.open(file, std::ios::binary);
  if (!stream.is_open()) return "missing";
  std::vector<std::uint64_t> words(std::size_t{1} << 17);
  std::uintmax_t size = 0;
  std::uint64_t sum = checksum({});
  do {
    stream.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(words[0])));
    const auto read = static_cast<std::size_t>(stream.gcount());
    for (std::size_t i = 0; i < read / sizeof(words[0]); ++i) {
      sum = checksum_of_word(words[i], sum);
    }
    const std::size_t whole = read - read % sizeof(words[0]);
    sum = checksum({reinterpret_cast<const char*>(words.data()) + whole, read - whole}, sum);
    size += read;
  } while (stream);
  return fmt::format("{} bytes, {:016x}", size, sum);
}

ResultCache::ResultCache(fs::path folder, const fs::path& program)
    : folder_(std::move(folder)), program_(file_identity(program)) {
  solver::make_folder(folder_);
}

std::optional<Json> ResultCache::find(const std::string& name, const std::string& cache_key,
                                      const fs::path& beside) const {
  Json found = find_json(file(name));
  if (!found.is_object() || !found.contains("result") || !found["result"].is_object()) return std::nullopt;
  if (json_text(found) != json_text(entry(program_, cache_key, found["result"], beside))) return std::nullopt;
  return std::move(found["result"]);
}

void ResultCache::keep(const std::string& name, const std::string& cache_key, const Json& result,
                       const fs::path& beside) const {
  // The folder is the cache's own: anything but a plain file in a result's place is damage. Several processes
  // may be here: with a slash at its end a name is a folder's, and a result that another has kept stays.
  std::error_code no_folder;
  if (!fs::remove(file(name) / "", no_folder)) {  // with something in it, which may be somebody's
    fs::rename(file(name) / "", file(name) += fmt::format(".aside-{:08x}", std::random_device{}()), no_folder);
  }
  solver::replace_whole_file(file(name), json_text(entry(program_, cache_key, result, beside), 1) + "\n");
}

}  // namespace slipstick::convergence
