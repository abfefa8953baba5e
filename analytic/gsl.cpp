#include "analytic/gsl.hpp"

#include <fmt/core.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_interp.h>
#include <gsl/gsl_roots.h>

#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

namespace slipstick::analytic::gsl {

namespace {

/// A C++ function as GSL calls it. An exception must not cross GSL's C frames: it waits here until they are left.
class Callback {
 public:
  explicit Callback(const RealFunction& f) : f_(f) { turn_abort_handler_off(); }
  gsl_function handle() {
    return {.function = [](double x, void* self) { return static_cast<Callback*>(self)->call(x); }, .params = this};
  }
  /// Throws what the function threw, or else what GSL's status says.
  void check(int status) const {
    if (thrown_) std::rethrow_exception(thrown_);
    gsl::check(status);
  }

 private:
  double call(double x) {
    try {
      return f_(x);
    } catch (...) {
      thrown_ = std::current_exception();
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

  const RealFunction& f_;
  std::exception_ptr thrown_;
};

/// GSL's handle in a unique_ptr; GSL gives null when out of memory.
template <class Handle>
auto own(Handle* handle, void (*release)(Handle*)) {
  if (!handle) throw std::bad_alloc();
  return std::unique_ptr<Handle, void (*)(Handle*)>(handle, release);
}

}  // namespace

void turn_abort_handler_off() { [[maybe_unused]] static const auto previous = gsl_set_error_handler_off(); }

void check(int status) {
  if (status == GSL_SUCCESS) return;
  const auto message = fmt::format("GSL: {}", gsl_strerror(status));
  if (status == GSL_EDOM) throw std::domain_error(message);
  throw std::runtime_error(message);
}

double root(const RealFunction& f, double low, double high) {
  constexpr int kMaxIterations = 200;  // plain bisection would need about 60
  constexpr double kRelative = 4 * std::numeric_limits<double>::epsilon();

  Callback callback(f);
  gsl_function function = callback.handle();
  const auto solver = own(gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  callback.check(gsl_root_fsolver_set(solver.get(), &function, low, high));
  int status = GSL_CONTINUE;
  for (int i = 0; i < kMaxIterations && status == GSL_CONTINUE; ++i) {
    callback.check(gsl_root_fsolver_iterate(solver.get()));
    status = gsl_root_test_interval(gsl_root_fsolver_x_lower(solver.get()), gsl_root_fsolver_x_upper(solver.get()), 0,
                                    kRelative);
  }
  check(status);
  return gsl_root_fsolver_root(solver.get());
}

double integral(const RealFunction& f, double low, double high, double relative) {
  constexpr std::size_t kIntervals = 200;

  Callback callback(f);
  gsl_function function = callback.handle();
  const auto workspace = own(gsl_integration_cquad_workspace_alloc(kIntervals), gsl_integration_cquad_workspace_free);
  double result = 0;
  callback.check(gsl_integration_cquad(&function, low, high, 0, relative, workspace.get(), &result, nullptr, nullptr));
  return result;
}

GaussRule::GaussRule(std::size_t points) {
  turn_abort_handler_off();
  const auto table = own(gsl_integration_glfixed_table_alloc(points), gsl_integration_glfixed_table_free);
  for (std::size_t i = 0; i < points; ++i) {
    Node node{};
    check(gsl_integration_glfixed_point(0, 1, i, &node.fraction, &node.weight, table.get()));
    nodes_.push_back(node);
  }
}

std::vector<double> steffen_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  turn_abort_handler_off();
  const auto interpolation = own(gsl_interp_alloc(gsl_interp_steffen, x.size()), gsl_interp_free);
  check(gsl_interp_init(interpolation.get(), x.data(), y.data(), x.size()));
  std::vector<double> slopes;
  for (const double knot : x) {
    double slope = 0;
    check(gsl_interp_eval_deriv_e(interpolation.get(), x.data(), y.data(), knot, nullptr, &slope));
    slopes.push_back(slope);
  }
  return slopes;
}

}  // namespace slipstick::analytic::gsl
