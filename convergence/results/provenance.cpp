#include "convergence/results/provenance.hpp"

#include <fftw3.h>
#include <fmt/core.h>
#include <gsl/gsl_version.h>

#include <Eigen/Core>

#include "commit.hpp"  // written by the build
#include "convergence/system/machine.hpp"

namespace slipstick::convergence {
Provenance provenance(int threads) {
  static const std::string cpu = processor_name();  // a file that takes long to read
  return {.version = SLIPSTICK_VERSION,
          .commit = kCommit,
          .compiler = fmt::format("{} {}", SLIPSTICK_COMPILER, __VERSION__),
          .flags = SLIPSTICK_FLAGS,
          .libraries = fmt::format("Eigen {}.{}.{}, {}, GSL {}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                   EIGEN_MINOR_VERSION, fftw_version, GSL_VERSION),
          .cpu = cpu,
          .threads = threads};
}

}  // namespace slipstick::convergence
