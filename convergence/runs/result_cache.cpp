#include "convergence/runs/result_cache.hpp"

#include <fmt/core.h>

#include <fstream>
#include <iterator>
#include <utility>

#include "convergence/results/whole_file.hpp"

namespace slipstick::convergence {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string identify_program() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return "unknown program";
  return fmt::format("{} bytes, written {}", fs::file_size(program),
                     fs::last_write_time(program).time_since_epoch().count());
}

/// The executable that runs, whatever becomes of its file meanwhile.
const std::string& program() {
  static const std::string identity = identify_program();
  return identity;
}

}  // namespace

void write_json_file(const fs::path& file, const Json& json) {
  const std::string content = json.dump(1) + "\n";
  std::ifstream old(file);
  if (old && fs::is_regular_file(file) && std::string(std::istreambuf_iterator<char>(old), {}) == content)
    return;
  write_whole_file(file, content);
}

Journal::Journal(fs::path folder) : folder_(std::move(folder)), program_(program()) {
  fs::create_directories(folder_);
}

std::optional<Json> Journal::find(const std::string& name, const std::string& question) const {
  std::ifstream stream(file(name));
  const Json found = stream && fs::is_regular_file(file(name)) ? Json::parse(stream, nullptr, false) : Json();
  const bool finished = found.is_object() && found.value("program", "") == program_ &&
                        found.value("question", "") == question && found.contains("result");
  return finished ? std::optional(found["result"]) : std::nullopt;
}

void Journal::keep(const std::string& name, const std::string& question, const Json& result) const {
  write_json_file(file(name), {{"program", program_}, {"question", question}, {"result", result}});
}

Json Journal::point(const std::string& name, const std::string& question,
                    const std::function<Json()>& compute, const fs::path& also) {
  std::optional<Json> found = find(name, question);
  reused_ = found && (also.empty() || fs::exists(also));
  if (reused_) return *std::move(found);
  fs::remove(
      file(name));  // so that a kill while the other file is written leaves nothing that looks finished
  Json result = compute();
  keep(name, question, result);
  return result;
}

}  // namespace slipstick::convergence
