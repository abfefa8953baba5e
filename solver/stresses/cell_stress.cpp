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

const std::array<StressKernel, kStressKernels> stress_kernels{
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
  const double xz = x * x + z * z, yz = y * y + z * z;
  const double Lxx = std::atan(x * y / (xz + R * z)), Lyy = std::atan(x * y / (yz + R * z));
  const double Lxy = std::log(R + z);
  const double Hx = std::asinh(y / std::sqrt(xz)), Hy = std::asinh(x / std::sqrt(yz)), Hz = -Lxx - Lyy;
  const double Hxy = 1.0 / R;
  const double Hxx = -x * y * Hxy / xz, Hyy = -x * y * Hxy / yz;
  const double Hxz = -z * y * Hxy / xz, Hyz = -z * x * Hxy / yz;
  const double Vx = -x / (R + z), Vy = -y / (R + z);
  const double Lx = -Vx * Hxy, Ly = -Vy * Hxy;
  const double s = 1.0 - 2.0 * nu, t = 2.0 * nu;
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
  for (double& value : values) value *= 0.5 * std::numbers::inv_pi;
  return values;
}

}  // namespace slipstick::solver
