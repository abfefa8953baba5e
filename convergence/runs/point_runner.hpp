#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

/// Solves points side by side, each in a process of its own, as many at a time as there are processors and
/// memory allows. Finished points are kept in a journal on disk and never computed again by the same program;
/// an interrupt or a killed process loses at most the points being computed. The processes end with this one
/// (see fork_child), and leave its other children alone. Says on standard error how far it is.
class PointRunner {
 public:
  /// jobs: processes at a time; 0: one a processor.
  explicit PointRunner(std::filesystem::path folder, int jobs = 0);

  /// The results, in the order of the points; equal points are computed once. A point whose process was
  /// killed or failed has status = "failed", a message and `run`, which says which it was. Throws InputError,
  /// before anything is computed, for a scene that cannot be read; std::runtime_error after SIGINT, SIGTERM
  /// or SIGHUP.
  std::vector<Json> run(const std::vector<Point>& points);

  /// The same for one.
  Json run(const Point& point);

 private:
  std::filesystem::path folder_;
  int jobs_;
};

}  // namespace slipstick::convergence
