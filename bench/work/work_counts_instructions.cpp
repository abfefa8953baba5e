#include "bench/work/work_counts_instructions.hpp"

#include <fmt/core.h>

#include <cctype>
#include <fstream>
#include <list>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "convergence/programs/temporary_folder.hpp"
#include "convergence/system/run_program.hpp"

namespace slipstick::bench {
namespace {

namespace fs = std::filesystem;

/// The function that callgrind counts in, as it writes its name.
constexpr const char* kCounted = "*do_counted_work*";

[[gnu::noinline]] void do_counted_work(const std::function<SolveWork()>& work) { work(); }

/// "(3) /lib/libm.so.6" names object 3, a later "(3)" refers to that name.
std::string object_name(const std::string& text, std::map<std::string, std::string>& names) {
  const std::size_t close = text.find(')');
  if (!text.starts_with('(') || close == std::string::npos) return text;
  std::string& name = names[text.substr(0, close + 1)];
  if (text.size() > close + 2) name = text.substr(close + 2);
  return name;
}

/// The first event's count on a line "position count ...", where the position may be relative.
std::optional<long> own_count(const std::string& line) {
  if (line.empty() || (std::isdigit(static_cast<unsigned char>(line[0])) == 0 && line[0] != '+' &&
                       line[0] != '-' && line[0] != '*')) {
    return std::nullopt;
  }
  std::istringstream words(line);
  std::string position;
  long count = 0;
  words >> position >> count;
  return count;
}

/// valgrind on one case.
std::vector<std::string> valgrind(const fs::path& program, const std::string& name, const fs::path& output) {
  return {"valgrind",
          "--tool=callgrind",
          "--quiet",
          "--callgrind-out-file=" + output.string(),
          std::string("--toggle-collect=") + kCounted,
          program.string(),
          "--do",
          name};
}

/// Whether there is a valgrind.
bool wait_for(convergence::Program& child, const std::string& name) {
  const convergence::ProgramEnd end = child.wait();
  if (!end.started || end.code == 0) return end.started;
  throw std::runtime_error(fmt::format("{} under valgrind {}", name, end.trouble));
}

}  // namespace

Instructions read_callgrind(const fs::path& file) {
  std::ifstream stream(file);
  Instructions instructions;
  std::map<std::string, std::string> names;
  std::string object;
  std::optional<long> total;
  bool of_call = false;  // what a call takes inside stands below it, and again where it is executed
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("ob=")) {
      object = object_name(line.substr(3), names);
    } else if (line.starts_with("cob=")) {
      object_name(line.substr(4), names);
    } else if (line.starts_with("totals:")) {
      total = std::stol(line.substr(7));
    } else if (const auto count = own_count(line)) {
      if (!of_call) instructions[fs::path(object).filename()] += *count;
    }
    of_call = line.starts_with("calls=");
  }
  const long sum = std::accumulate(instructions.begin(), instructions.end(), 0L,
                                   [](long before, const auto& part) { return before + part.second; });
  if (!total || sum == 0 || sum != *total) {
    throw std::runtime_error(fmt::format("{}: not what callgrind writes: {} instructions of {}",
                                         file.string(), sum, total.value_or(0)));
  }
  return instructions;
}

void do_case(const WorkCase& work_case) { do_counted_work(work_case.prepare()); }

std::optional<std::map<std::string, Instructions>> run_callgrind(const fs::path& program,
                                                                 const std::vector<WorkCase>& cases) {
  const convergence::TemporaryFolder folder;
  const auto output = [&](const WorkCase& work_case) { return folder / work_case.name.c_str(); };
  const std::size_t at_a_time = std::max(1U, std::thread::hardware_concurrency());
  std::map<std::string, Instructions> found;
  for (std::size_t first = 0; first < cases.size(); first += at_a_time) {
    const std::size_t last = std::min(first + at_a_time, cases.size());
    std::list<convergence::Program> children;
    for (std::size_t i = first; i < last; ++i) {
      children.emplace_back(valgrind(program, cases[i].name, output(cases[i])));
    }
    bool installed = true;
    auto child = children.begin();
    for (std::size_t i = first; i < last; ++i) installed &= wait_for(*child++, cases[i].name);
    if (!installed) return std::nullopt;
    for (std::size_t i = first; i < last; ++i) {
      found[cases[i].name] = read_callgrind(output(cases[i]));
    }
  }
  return found;
}

}  // namespace slipstick::bench
