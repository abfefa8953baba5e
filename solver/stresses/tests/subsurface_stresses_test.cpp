#include "solver/stresses/subsurface_stresses.hpp"

#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

// The order of convergence, and the largest stresses: convergence/stresses/tests/stress_files_test.py.

using Tensor = std::array<double, kStresses>;

/// Boussinesq's point solution of a unit force along x3, and Cerruti's of one along x1 (Johnson 1985, section
/// 3.2 and 3.6, times 2 pi there).
Tensor boussinesq(double x, double y, double z, double nu) {
  const double R = std::sqrt(x * x + y * y + z * z), R3 = R * R * R;
  const double r2 = x * x + y * y, s = (1.0 - 2.0 * nu) / r2;
  const double three = 3.0 * z / (R3 * R * R);
  const double c = (1.0 - z / R) / r2;
  return {s * (c * (x * x - y * y) + z * y * y / R3) - three * x * x,
          s * (c * (y * y - x * x) + z * x * x / R3) - three * y * y,
          -three * z * z,
          s * (2.0 * c - z / R3) * x * y - three * x * y,
          -three * x * z,
          -three * y * z};
}
Tensor cerruti(double x, double y, double z, double nu) {
  const double R = std::sqrt(x * x + y * y + z * z), R3 = R * R * R;
  const double s = 1.0 - 2.0 * nu;
  const double a = 1.0 / (R * (R + z) * (R + z));
  const double b = a / (R * R) + 2.0 * a / (R * (R + z));
  const double three = 3.0 * x / (R3 * R * R);
  return {-three * x * x + s * x * (1.0 / R3 - 3.0 * a + x * x * b),
          -three * y * y + s * x * (1.0 / R3 - a + y * y * b),
          -three * z * z,
          -three * x * y + s * y * (x * x * b - a),
          -three * x * z,
          -three * y * z};
}

/// Under a unit force along x2: cerruti() with x1 and x2 exchanged.
Tensor point_solution(std::size_t traction, double x, double y, double z, double nu) {
  if (traction == 0) return boussinesq(x, y, z, nu);
  if (traction == 1) return cerruti(x, y, z, nu);
  const Tensor s = cerruti(y, x, z, nu);
  return {s[k22], s[k11], s[k33], s[k12], s[k23], s[k13]};
}

/// Stresses at a point by each unit traction on the cell (-h1/2, h1/2) x (-h2/2, h2/2).
std::array<Tensor, kTractions> cell_stress(double x1, double x2, double depth, const Grid& cell, double nu) {
  std::array<Tensor, kTractions> result{};
  for (const double side1 : {-0.5, 0.5}) {
    for (const double side2 : {-0.5, 0.5}) {
      const KernelValues corner = corner_function(x1 - side1 * cell.h1, x2 - side2 * cell.h2, depth, nu);
      for (std::size_t k = 0; k < kStressKernels; ++k)
        for (std::size_t u = 0; u < stress_kernels[k].count; ++u) {
          const auto& [traction, stress] = stress_kernels[k].influences[u];
          result[traction][stress] += side1 * side2 * 4.0 * corner[k];
        }
    }
  }
  return result;
}

constexpr Grid kCell{1, 1, 0.8, 1.3};

/// Points inside and outside the cell's outline, on all sides.
const std::array<std::array<double, 3>, 6> kPoints{
    {{0.1, -0.2, 0.5}, {1.3, 0.4, 0.3}, {-0.7, 1.9, 1.1}, {-2.5, -3.1, 0.7}, {0.9, -1.2, 4.0}, {0.4, 0.65, 0.6}}};

TEST(CellStress, IsThePointSolutionIntegratedOverTheCell) {
  const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> gauss(
      gsl_integration_glfixed_table_alloc(128), gsl_integration_glfixed_table_free);
  const double nu = 0.27;
  for (const auto& [x, y, z] : kPoints) {
    const auto closed = cell_stress(x, y, z, kCell, nu);
    for (std::size_t b = 0; b < kTractions; ++b) {
      Tensor sum{};
      for (std::size_t node = 0; node < 128 * 128; ++node) {
        double u, v, weight_u, weight_v;
        gsl_integration_glfixed_point(-0.5 * kCell.h1, 0.5 * kCell.h1, node / 128, &u, &weight_u, gauss.get());
        gsl_integration_glfixed_point(-0.5 * kCell.h2, 0.5 * kCell.h2, node % 128, &v, &weight_v, gauss.get());
        const Tensor point = point_solution(b, x - u, y - v, z, nu);
        for (std::size_t a = 0; a < kStresses; ++a)
          sum[a] += 0.5 * std::numbers::inv_pi * weight_u * weight_v * point[a];
      }
      for (std::size_t a = 0; a < kStresses; ++a)
        EXPECT_NEAR(closed[b][a], sum[a], 1e-12) << "traction " << b << ", stress " << a << " at " << x;
    }
  }
}

/// div sigma = 0, by central differences of fourth order.
TEST(CellStress, IsInEquilibrium) {
  constexpr std::array<std::array<Stress, 3>, 3> kRows{{{k11, k12, k13}, {k12, k22, k23}, {k13, k23, k33}}};
  constexpr double kStep = 2e-3;
  for (const auto& point : kPoints) {
    std::array<std::array<double, 3>, kTractions> divergence{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const auto& [steps, weight] : {std::pair(1, 8.0), {-1, -8.0}, {2, -1.0}, {-2, 1.0}}) {
        auto at = point;
        at[axis] += steps * kStep;
        const auto stress = cell_stress(at[0], at[1], at[2], kCell, 0.4);
        for (std::size_t b = 0; b < kTractions; ++b)
          for (std::size_t row = 0; row < 3; ++row)
            divergence[b][row] += weight * stress[b][kRows[row][axis]] / (12.0 * kStep);
      }
    }
    for (const auto& by_traction : divergence)
      for (const double value : by_traction) EXPECT_NEAR(value, 0.0, 1e-8);
  }
}

/// Random tractions on cells that are no squares.
SolutionFields random_fields(const Grid& grid) {
  SolutionFields fields;
  fields.grid = grid;
  fields.pressure = random_field(grid.cells(), 1) + 2.0;
  fields.traction = random_field(2 * grid.cells(), 2);
  return fields;
}

TEST(SubsurfaceStresses, AreTheSumOverAllCells) {
  for (const Grid grid : {Grid{7, 10, 0.8, 1.3}, Grid{6, 3, 1.0, 0.5}, Grid{1, 1, 0.8, 1.3}}) {
    const SolutionFields fields = random_fields(grid);
    for (const Body body : {Body::lower, Body::upper}) {
      const double sign = body == Body::lower ? 1.0 : -1.0;
      SubsurfaceStresses stresses(fields, 0.3, body, 2);
      for (const double depth : {0.4, 3.0}) {
        const StressPlane plane = stresses.at(depth);
        for (Index at = 0; at < grid.cells(); ++at) {
          Tensor sum{};
          for (Index from = 0; from < grid.cells(); ++from) {
            const auto cell = cell_stress(grid.x1(at / grid.n2) - grid.x1(from / grid.n2),
                                          grid.x2(at % grid.n2) - grid.x2(from % grid.n2), depth, grid, 0.3);
            for (std::size_t a = 0; a < kStresses; ++a)
              sum[a] += fields.pressure[from] * cell[0][a] + sign * fields.traction[from] * cell[1][a] +
                        sign * fields.traction[grid.cells() + from] * cell[2][a];
          }
          const auto [pressure, shear] =
              stresses_at(fields, 0.3, body, {{grid.x1(at / grid.n2), grid.x2(at % grid.n2), depth}})[0];
          for (std::size_t a = 0; a < kStresses; ++a) {
            EXPECT_NEAR(plane.stress[a][at], sum[a], 1e-12) << a << " at cell " << at;
            EXPECT_NEAR(pressure[a] + shear[a], sum[a], 1e-12) << a << " at cell " << at;
          }
        }
      }
    }
  }
}

/// With the normal -x3 of the body's surface, the traction is (-s13, -s23, -s33).
TEST(SubsurfaceStresses, CarryTheTractionsJustBelowTheSurface) {
  const Grid grid{9, 8, 0.8, 1.3};
  const SolutionFields fields = random_fields(grid);
  const StressPlane plane = SubsurfaceStresses(fields, 0.3, Body::lower).at(1e-6);
  EXPECT_TRUE(plane.stress[k33].isApprox(-fields.pressure, 1e-5));
  EXPECT_TRUE(plane.stress[k13].isApprox(-fields.traction.head(grid.cells()), 1e-5));
  EXPECT_TRUE(plane.stress[k23].isApprox(-fields.traction.tail(grid.cells()), 1e-5));
}

/// The part (1 + (r/z)^2)^(-3/2) of a point force acts outside a circle of radius r.
TEST(SubsurfaceStresses, CarryTheNormalLoadThroughAPlane) {
  const Grid grid{128, 128, 1.0, 1.0};
  SolutionFields fields = random_fields(grid);
  fields.traction.setZero();
  fields.pressure.setZero();
  const Index middle = 64 * grid.n2 + 64;
  fields.pressure[middle] = 3.0;
  fields.traction[middle] = 2.0;
  const StressPlane plane = SubsurfaceStresses(fields, 0.3, Body::lower).at(2.0);
  EXPECT_NEAR(plane.stress[k33].sum(), -3.0, 3.0 * std::pow(1.0 + 31.0 * 31.0, -1.5));
}

TEST(SubsurfaceStresses, KeepNaNAsTheLargest) {
  const Grid grid{2, 2, 1.0, 1.0};
  StressPlane plane{1.0, {}};
  for (Eigen::ArrayXd& field : plane.stress) field.setOnes(4);
  plane.stress[k33][1] = std::numeric_limits<double>::quiet_NaN();
  LargestStresses largest;
  largest.include(plane, grid);
  EXPECT_TRUE(std::isnan(largest.von_mises.value));
}

TEST(SubsurfaceStresses, RefuseASurfaceAndAQuadrant) {
  SolutionFields fields = random_fields({4, 4, 1.0, 1.0});
  SubsurfaceStresses stresses(fields, 0.3, Body::lower);
  for (const double depth : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(stresses.at(depth), std::domain_error);
    EXPECT_THROW(stresses_at(fields, 0.3, Body::lower, {{0.0, 0.0, depth}}), std::domain_error);
  }
  fields.grid.quadrant = true;
  EXPECT_THROW(SubsurfaceStresses(fields, 0.3, Body::lower), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::solver
