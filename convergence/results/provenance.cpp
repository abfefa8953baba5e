#include "convergence/results/provenance.hpp"

#include <fftw3.h>
#include <fmt/core.h>
#include <gsl/gsl_version.h>

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "commit.hpp"  // written by the build

namespace slipstick::convergence {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

nlohmann::ordered_json provenance(int threads) {
  return {{"version", SLIPSTICK_VERSION},
          {"commit", kCommit},
          {"compiler", fmt::format("{} {}", SLIPSTICK_COMPILER, __VERSION__)},
          {"flags", SLIPSTICK_FLAGS},
          {"libraries", fmt::format("Eigen {}.{}.{}, {}, GSL {}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                    EIGEN_MINOR_VERSION, fftw_version, GSL_VERSION)},
          {"cpu", processor()},
          {"threads", threads}};
}

}  // namespace slipstick::convergence
