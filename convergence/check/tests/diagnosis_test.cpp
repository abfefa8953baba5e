// Fields made with a wrong kernel, and the mistakes that they are traced to.

#include "convergence/check/diagnosis.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "convergence/check/tests/checked_field.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "docs/extend/examples/method.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"
#include "solver/step/pressure.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

/// K12 at an offset whose signs along x1 and x2 multiply to `sign`, from its value at the positive one.
using CrossKernel = std::function<double(double k12, int sign)>;

/// The tangential operator with another cross kernel, and perhaps with K11 and K22 exchanged, as a matrix.
class OtherKernel final : public solver::LinearOperator {
 public:
  OtherKernel(const solver::Grid& grid, const solver::ElasticLaw& law, const CrossKernel& cross,
              bool exchanged)
      : LinearOperator(grid, solver::tangential_kernel()), matrix_(2 * grid.cells(), 2 * grid.cells()) {
    const std::array components{solver::Component::k11, solver::Component::k12, solver::Component::k22};
    const auto tables = law.influence_tables(components, grid);
    const Index cells = grid.cells();
    for (Index to = 0; to < cells; ++to) {
      for (Index from = 0; from < cells; ++from) {
        const Index k1 = to / grid.n2 - from / grid.n2;
        const Index k2 = to % grid.n2 - from % grid.n2;
        const auto at = static_cast<std::size_t>(std::abs(k1) * grid.n2 + std::abs(k2));
        matrix_(to, from) = tables[exchanged ? 2 : 0][at];
        matrix_(to, from + cells) = matrix_(to + cells, from) =
            cross(tables[1][at], (k1 < 0) == (k2 < 0) ? 1 : -1);
        matrix_(to + cells, from + cells) = tables[exchanged ? 0 : 2][at];
      }
    }
  }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    const auto size = static_cast<Index>(traction.size());
    Eigen::Map<Eigen::VectorXd>(displacement.data(), size).noalias() =
        matrix_ * Eigen::Map<const Eigen::VectorXd>(traction.data(), size);
  }
  Eigen::MatrixXd matrix_;
};

double right_cross(double k12, int sign) { return sign * k12; }

/// As a program writes it on a model's grid. Dimensionless fields.
GivenContact made_contact(const solver::Dimensionless& model, const Eigen::ArrayXd& pressure,
                          const Eigen::ArrayXd& traction) {
  return {model, {.law = model.law}, {0.0, 0.0}, pressure, traction};
}

/// A contact with tractions by an operator of its own. poisson: its Poisson compliance over the right one.
GivenContact computed_with(const solver::Scene& scene, const CrossKernel& cross, bool exchanged = false,
                           double poisson = 1.0) {
  const solver::Model model = solver::make_model(scene);
  const solver::Step& load = scene.steps.front();
  const Eigen::ArrayXd pressure = find_pressure(scene, model, load).pressure;
  solver::ElasticPair pair = model.pair;
  pair.poisson_compliance *= poisson;
  OtherKernel op(model.grid, solver::HalfSpaces(pair), cross, exchanged);
  const auto solution =
      example::solve_by_plain_gradient(op, load_step(scene, model, load, pressure, {}).problem, 1e-8, 20000);
  EXPECT_EQ(solution.status, solver::Status::converged) << solution.message;
  return made_contact(model, pressure, solution.traction);
}

GivenContact computed_with(const CrossKernel& cross, bool exchanged = false,
                           const std::string& name = "ellipse", double poisson = 1.0) {
  return computed_with(example(name, {name == "ellipse" ? "grid.cells=[24,12]" : "grid.cells=[20,20]"}),
                       cross, exchanged, poisson);
}

/// Gap over energy that a mesh of so few cells explains.
constexpr double kAllowed = 1e-3;

TEST(Diagnosis, NamesTheKernelThatWasUsed) {
  const std::vector<std::pair<CrossKernel, std::string_view>> mistakes{
      {[](double, int) { return 0.0; }, mistake::cross_kernel_missing},
      {[](double k12, int sign) { return -sign * k12; }, mistake::cross_kernel_sign},
      {[](double k12, int) { return -std::abs(k12); }, mistake::cross_kernel_even},
      {[](double k12, int) { return std::abs(k12); }, mistake::cross_kernel_even}};
  for (const auto& [cross, expected] : mistakes) {
    const Diagnosis diagnosis = diagnose(computed_with(cross), {}, kAllowed);
    SCOPED_TRACE(sentence({expected}));
    ASSERT_TRUE(diagnosis.kernel);
    EXPECT_EQ(diagnosis.kernel->cause.mistake, expected);
    EXPECT_LE(diagnosis.kernel->gap, 1e-6);
    EXPECT_GT(diagnosis.reference_kernel.gap, kAllowed);
    EXPECT_FALSE(diagnosis.friction);
    if (cross(1.0, 1) == cross(1.0, -1) && cross(1.0, 1) != 0.0) continue;
    const Diagnosis of_sphere = diagnose(computed_with(cross, false, "paper"), {}, 0.1);
    ASSERT_TRUE(of_sphere.kernel);
    EXPECT_EQ(of_sphere.kernel->cause.mistake, expected);
  }
}

// Under Tresca's law coarse meshes leave most of the tractions open, though not to a program with this mesh's
// cells: its tractions are near the right ones, and a kernel other than the right one explains them.
TEST(Diagnosis, FindsAPartOfTheCrossKernelBadWhereTheMeshLeavesTractionsOpen) {
  const solver::Scene scene =
      example("paper", {"contact.friction_law=tresca", "contact.shear_strength=1e8", "grid.cells=[24,24]",
                        "grid.extent=[1.125e-3,1.125e-3]", "load.moment_ratio=0.7"});
  for (const double part : {1.0, 0.7, 1.3}) {
    const GivenContact contact =
        computed_with(scene, [=](double k12, int sign) { return part * sign * k12; });
    FieldRows rows;
    const solver::Grid grid = contact.grid_in_m();
    for (Index cell = 0; cell < grid.cells(); ++cell) {
      if (!(contact.pressure[cell] > 0.0)) continue;
      rows.push_back({solver::cell_x1(grid)[cell], solver::cell_x2(grid)[cell],
                      contact.stress_unit * contact.pressure[cell],
                      contact.stress_unit * contact.traction[cell],
                      contact.stress_unit * contact.traction[cell + grid.cells()]});
    }
    if (part == 1.0) {
      find_good(rows, scene);
    } else {
      find_bad(rows, scene, names(mistake::cross_kernel_factor, part));
    }
  }
}

// With a Poisson's ratio of zero K11 and K22 are wrong, too, but not exchanged.
TEST(Diagnosis, DistinguishesExchangedKernelsFromPoissonsRatio) {
  const Diagnosis diagnosis = diagnose(computed_with(right_cross, true), {}, kAllowed);
  ASSERT_TRUE(diagnosis.kernel);
  EXPECT_EQ(diagnosis.kernel->cause.mistake, mistake::kernels_exchanged);
  EXPECT_LE(diagnosis.kernel->gap, 1e-6);
}

TEST(Diagnosis, FindsNoMistakeInTheRightKernel) {
  const Diagnosis diagnosis = diagnose(computed_with(right_cross), {}, kAllowed);
  EXPECT_LE(diagnosis.reference_kernel.gap, 1e-6);
  EXPECT_FALSE(diagnosis.kernel);
  EXPECT_FALSE(diagnosis.friction);
}

/// The field of bodies with another Poisson's ratio and the same contact modulus E/(1 - nu^2).
GivenContact with_poissons_ratio(double ratio) {
  solver::Scene scene = example("ellipse", {"grid.cells=[32,16]"});
  const solver::Model model = solver::make_model(scene);
  for (solver::Material* material : {&scene.upper, &scene.lower}) {
    material->young_modulus *= (1.0 - ratio * ratio) / (1.0 - 0.3 * 0.3);
    material->poisson_ratio = ratio;
  }
  const solver::Solution solution = solver::solve(scene);
  return made_contact(model, solution.pressure / model.stress_unit, solution.traction / model.stress_unit);
}

TEST(Diagnosis, DeterminesPoissonsRatioFromTheField) {
  for (const double ratio : {0.1, 0.45}) {
    const Diagnosis diagnosis = diagnose(with_poissons_ratio(ratio), {}, 1e-5);
    ASSERT_TRUE(diagnosis.kernel) << ratio;
    EXPECT_EQ(diagnosis.kernel->cause.mistake, mistake::poisson_ratio);
    EXPECT_NEAR(diagnosis.kernel->cause.found, ratio, 5e-3 * ratio);
    EXPECT_NEAR(diagnosis.kernel->cause.expected, 0.3, 1e-9);
  }
}

// The ratio of bodies of unequal compliance is their mean. No body has one above 0.5.
TEST(Diagnosis, DeterminesPoissonsRatioOfDissimilarBodies) {
  for (const auto& [factor, ratio] : {std::pair{0.5, 0.16}, {1.4, 0.45}}) {
    const Diagnosis diagnosis =
        diagnose(computed_with(right_cross, false, "dissimilar", factor), {}, kAllowed);
    ASSERT_TRUE(diagnosis.kernel) << factor;
    EXPECT_EQ(diagnosis.kernel->cause.mistake, mistake::poisson_ratio);
    EXPECT_NEAR(diagnosis.kernel->cause.found, ratio, 0.01);
    EXPECT_LE(diagnosis.kernel->gap, 1e-5);
  }
  for (const char* name : {"dissimilar", "ellipse"}) {
    const Diagnosis diagnosis = diagnose(computed_with(right_cross, false, name, 1.8), {}, kAllowed);
    EXPECT_TRUE(std::ranges::none_of(diagnosis.tried, [](const Hypothesis& each) {
      return each.cause.mistake == mistake::poisson_ratio;
    }));
  }
}

// A missing cross kernel explains a field whose own was nearly missing: where it lowers the stick area's gap
// to a tenth. No other kernel that is tried has an effect on a sphere in torsion, or is as near.
TEST(Diagnosis, NamesAKernelThatLowersTheGapToATenth) {
  for (const auto& [left, is_named] : {std::pair{0.065, true}, {0.074, false}}) {
    const Diagnosis diagnosis = diagnose(
        computed_with([&](double k12, int sign) { return left * sign * k12; }, false, "paper"), {}, kAllowed);
    const double lowest = std::ranges::min(diagnosis.tried, {}, &Hypothesis::stick_gap).stick_gap;
    EXPECT_NEAR(lowest / diagnosis.reference_kernel.stick_gap, is_named ? 0.093 : 0.107, 0.006);
    EXPECT_EQ(diagnosis.kernel.has_value(), is_named) << left;
  }
}

// Any iteration may leave a gap of the stick area of 1e-4 or less. The gap is proportional to the error of
// Poisson's ratio.
TEST(Diagnosis, NamesNoKernelForAGapThatAnIterationLeaves) {
  const auto of = [](double off) { return diagnose(with_poissons_ratio(0.3 + off), {}, 1e-5); };
  const double off = 5e-4 * 1e-4 / of(5e-4).reference_kernel.stick_gap;
  const Diagnosis below = of(0.93 * off);
  EXPECT_NEAR(below.reference_kernel.stick_gap, 0.93e-4, 0.03e-4);
  EXPECT_FALSE(below.kernel);
  const Diagnosis above = of(1.07 * off);
  EXPECT_NEAR(above.reference_kernel.stick_gap, 1.07e-4, 0.03e-4);
  ASSERT_TRUE(above.kernel);
  EXPECT_EQ(above.kernel->cause.mistake, mistake::poisson_ratio);
  EXPECT_NEAR(above.kernel->cause.found, 0.3, 5e-3);
}

// By more than 1e-4 of its bound a cell has to stay below it, to stick.
TEST(Diagnosis, CountsCellsAsSlippingUpToTheToleranceOfTheirBound) {
  const GivenContact right = computed_with(right_cross);
  const double slipping = static_cast<double>(right.pressure.size()) - stick_cells(right).sum();
  const auto slipping_times = [&](double factor) {
    const Eigen::ArrayXd q = right.traction;
    const Eigen::ArrayXd on_circle =
        (solver::norms(q) >= (1.0 - 1e-6) * right.friction_bound).cast<double>().replicate(2, 1);
    const GivenContact lower = made_contact(right, right.pressure, q * (1.0 + (factor - 1.0) * on_circle));
    return static_cast<double>(right.pressure.size()) - stick_cells(lower).sum();
  };
  EXPECT_EQ(slipping_times(1.0 - 0.9e-4), slipping);
  EXPECT_LT(slipping_times(1.0 - 1.1e-4), 0.8 * slipping);
}

}  // namespace
}  // namespace slipstick::convergence
