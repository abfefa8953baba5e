#include "bench/timing/machine.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cctype>
#include <fstream>
#include <map>
#include <regex>
#include <utility>
#include <vector>

namespace slipstick::bench {
namespace {

/// Words of a processor's name that tell nothing, and its nominal frequency.
const std::regex kNoise(R"(\((r|tm|c)\)|\b(processor|cpu|@|[0-9.]+ghz|[0-9]+-core)(?![a-z0-9]))");
/// What /proc/cpuinfo tells of a processor: x86 by family and model, ARM by implementer and part.
const std::vector<std::pair<std::string, std::string>> kTelling{
    {"cpu family", "family"}, {"model", "model"}, {"CPU implementer", "implementer"}, {"CPU part", "part"}};

/// Lower case, letters and digits joined by single dashes.
std::string dashed(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0) {
      result += letter;
    } else if (!result.empty() && result.back() != '-') {
      result += '-';
    }
  }
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result;
}

std::string lower_case(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::string machine_key() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  const long level3 = sysconf(_SC_LEVEL3_CACHE_SIZE);
  return machine_key(cpuinfo, level3 > 0 ? level3 : sysconf(_SC_LEVEL2_CACHE_SIZE));
}

std::string machine_key(std::istream& cpuinfo, long cache_bytes) {
  std::map<std::string, std::string> first;
  int cpus = 0;
  for (std::string line; std::getline(cpuinfo, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string key = trimmed(line.substr(0, colon));
    if (key == "processor") ++cpus;
    first.emplace(key, trimmed(line.substr(colon + 1)));
  }
  std::string key = dashed(std::regex_replace(lower_case(first["model name"]), kNoise, " "));
  if (key.empty()) key = "unknown";
  for (const auto& [name, word] : kTelling) {
    if (first.contains(name)) key += "-" + word + dashed(lower_case(first[name]));
  }
  key += fmt::format("-{}cpus", cpus);
  if (cache_bytes > 0) key += fmt::format("-cache-{}m", (cache_bytes + (1L << 19)) >> 20);
  return key;
}

}  // namespace slipstick::bench
