#include "convergence/system/machine.hpp"

#include <fstream>

namespace slipstick::convergence {

namespace fs = std::filesystem;

fs::path own_program() { return "/proc/self/exe"; }

fs::path own_program_file() {
  std::error_code error;
  return fs::read_symlink(own_program(), error);
}

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

bool starts_programs() { return true; }

}  // namespace slipstick::convergence
