#include "solver/stresses/cell_stress.hpp"

#include <cmath>
#include <numbers>

namespace slipstick::solver {
namespace {

constexpr std::size_t kPressure = 0, kShear1 = 1, kShear2 = 2;

constexpr StressKernel one(std::size_t traction, Stress stress, Parity parity) {
  return {{{{traction, stress}, {traction, stress}}}, 1, parity};
}
constexpr StressKernel shared(Influence first, Influence second, Parity parity) {
  return {{{first, second}}, 2, parity};
}

}  // namespace

const std::array<StressKernel, kStressKernels> kernels{
    one(kPressure, k11, {1, 1}),
    one(kPressure, k22, {1, 1}),
    one(kPressure, k33, {1, 1}),
    one(kPressure, k12, {-1, -1}),
    shared({kPressure, k13}, {kShear1, k33}, {-1, 1}),
    shared({kPressure, k23}, {kShear2, k33}, {1, -1}),
    shared({kShear1, k23}, {kShear2, k13}, {-1, -1}),
    one(kShear1, k11, {-1, 1}),
    one(kShear1, k22, {-1, 1}),
    one(kShear1, k12, {1, -1}),
    one(kShear1, k13, {1, 1}),
    one(kShear2, k11, {1, -1}),
    one(kShear2, k22, {1, -1}),
    one(kShear2, k12, {-1, 1}),
    one(kShear2, k23, {1, 1}),
};

/// With R = sqrt(x^2 + y^2 + z^2), H = 1/R, L = ln(R + z), V = z L - R, where V_zz = L_z = H, and indices for
/// derivatives, the point solutions are, times 2 pi,
///   pressure: s11 = -z H_xx - (1 - 2 nu) L_xx + 2 nu H_z, s33 = H_z - z H_zz,
///             s12 = -z H_xy - (1 - 2 nu) L_xy, s13 = -z H_xz;
///   shear 1:  s11 = 2 (1 + nu) H_x - z L_xxx + 2 nu V_xxx, s22 = 2 nu H_x - z L_xyy + 2 nu V_xyy,
///             s33 = -z H_xz, s12 = H_y - z L_xxy + 2 nu V_xxy, s13 = H_z - z H_xx, s23 = -z H_xy.
/// Below, a name such as Hx is the primitive in x and y of H_x, less what the four corners cancel.
KernelValues corner_function(double x, double y, double z, double nu) {
  const double R = std::sqrt(x * x + y * y + z * z);
  const double inverse = 1.0 / R;
  const double xz = x * x + z * z;
  const double yz = y * y + z * z;
  const double inverse_lz = 1.0 / (R + z);
  const double Lxx = std::atan(x * y / (xz + R * z));
  const double Lyy = std::atan(x * y / (yz + R * z));
  const double Lxy = std::log(R + z);
  const double Hx = std::asinh(y / std::sqrt(xz));
  const double Hy = std::asinh(x / std::sqrt(yz));
  const double Hz = -Lxx - Lyy;
  const double Hxx = -x * y * inverse / xz;
  const double Hyy = -x * y * inverse / yz;
  const double Hxy = inverse;
  const double Hxz = -z * y * inverse / xz;
  const double Hyz = -z * x * inverse / yz;
  const double Lx = x * inverse * inverse_lz;
  const double Ly = y * inverse * inverse_lz;
  const double Vx = -x * inverse_lz;
  const double Vy = -y * inverse_lz;
  const double s = 1.0 - 2.0 * nu;
  const double t = 2.0 * nu;
  constexpr double kScale = 0.5 * std::numbers::inv_pi;
  KernelValues values{-z * Hxx - s * Lxx + t * Hz,
                      -z * Hyy - s * Lyy + t * Hz,
                      Hz + z * (Hxx + Hyy),
                      -z * Hxy - s * Lxy,
                      -z * Hxz,
                      -z * Hyz,
                      -z * Hxy,
                      2.0 * Hx + z * (Hxz + Ly) - t * Vy,
                      t * Hx - z * Ly + t * Vy,
                      Hy - z * Lx + t * Vx,
                      Hz - z * Hxx,
                      t * Hy - z * Lx + t * Vx,
                      2.0 * Hy + z * (Hyz + Lx) - t * Vx,
                      Hx - z * Ly + t * Vy,
                      Hz - z * Hyy};
  for (double& value : values) value *= kScale;
  return values;
}

KernelValues cell_stress(double x1, double x2, double depth, const Grid& cell, double poisson) {
  KernelValues sum{};
  for (const double side1 : {-0.5, 0.5}) {
    for (const double side2 : {-0.5, 0.5}) {
      const KernelValues corner = corner_function(x1 - side1 * cell.h1, x2 - side2 * cell.h2, depth, poisson);
      for (std::size_t k = 0; k < kStressKernels; ++k) sum[k] += side1 * side2 * 4.0 * corner[k];
    }
  }
  return sum;
}

}  // namespace slipstick::solver
