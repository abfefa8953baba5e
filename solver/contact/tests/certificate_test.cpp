#include "solver/contact/certificate.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "docs/extend/examples/method.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/tests/limits.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Sums of some tens of numbers of size 1.
constexpr double kFewRoundings = 1e-14;

// --- members ---

/// Coulomb's law to the letter on 4 x 4 cells: the inner four stick, the others slip against their traction
/// at its bound. Everything is like a rotation, so the forces vanish.
class CoulombState : public testing::Test {
 protected:
  CoulombState() {
    const ArrayXd r = norms(t_);
    inner_ = (r < 1.0).cast<double>();
    bound_ = ArrayXd::Constant(16, 1.0);
    const ArrayXd direction = t_ / r.replicate(2, 1);
    q_ = (0.25 * inner_ + (1.0 - inner_)).replicate(2, 1) * direction;
    s_ = -0.3 * (1.0 - inner_).replicate(2, 1) * direction;
    u_ = 2.0 * q_;
    moment_ = (q_ * t_).sum();
  }
  Certificate certificate() const { return certify({q_, u_, s_}, bound_, t_, moment_); }
  double energy() const { return 0.5 * (q_ * u_).sum(); }
  static constexpr Index kInner = 5;  // cell (1, 1)
  static constexpr Index kOuter = 0;

  Grid grid_{4, 4, 1.0, 1.0};
  ArrayXd t_ = rotation_field(grid_);
  ArrayXd inner_, bound_, q_, s_, u_;
  double moment_ = 0.0;
};

/// Each way to break a law shows in its own number, by the size that theory says.
TEST_F(CoulombState, ShowsWhichLawIsBrokenAndByHowMuch) {
  const ArrayXd q = q_, s = s_, bound = bound_;
  const double moment = moment_;
  const auto expect_certificate = [&](double gap, double of_moment, double force, double friction_bound) {
    const Certificate c = certificate();
    EXPECT_NEAR(c.gap, gap, kFewRoundings);
    EXPECT_NEAR(c.moment, of_moment, kFewRoundings);
    EXPECT_NEAR(c.force, force, kFewRoundings);
    EXPECT_NEAR(c.friction_bound, friction_bound, kFewRoundings);
    q_ = q, s_ = s, bound_ = bound, moment_ = moment;
  };
  expect_certificate(0.0, 0.0, 0.0, 0.0);
  s_[kInner] = 0.2;  // slip in a sticking cell
  s_[16 + kInner] = 0.1;
  expect_certificate((0.2 * q[kInner] + 0.1 * q[16 + kInner] + std::hypot(0.2, 0.1)) / energy(), 0.0, 0.0, 0.0);
  std::swap(s_[kOuter], s_[16 + kOuter]);  // slip turned by a right angle
  s_[kOuter] *= -1.0;
  expect_certificate(0.3 / energy(), 0.0, 0.0, 0.0);
  s_[kOuter] *= -1.0;  // slip along the traction
  s_[16 + kOuter] *= -1.0;
  expect_certificate(0.6 / energy(), 0.0, 0.0, 0.0);
  bound_[kOuter] = 1.5;  // slip below the bound
  expect_certificate(0.5 * 0.3 / energy(), 0.0, 0.0, 0.0);
  bound_[kInner] = 0.2;  // traction beyond the bound, by a part of it
  expect_certificate(0.0, 0.0, 0.0, 0.25);
  moment_ *= 1.1;  // another moment, by a part of the limit
  expect_certificate(0.0, 0.1 * moment / norms(t_).sum(), 0.0, 0.0);
  bound_[kInner] = 0.0;  // traction outside the contact
  EXPECT_EQ(certificate().friction_bound, std::numeric_limits<double>::infinity());
}

TEST_F(CoulombState, WithAForceSaysItsPartOfTheFriction) {
  q_.head(16) += 0.1 * inner_;
  const Certificate c = certificate();
  EXPECT_NEAR(c.force, 0.4 / 16.0, kFewRoundings);
  EXPECT_NEAR(c.moment, 0.0, kFewRoundings);
  EXPECT_NEAR(c.friction_bound, 0.0, kFewRoundings);
}

TEST_F(CoulombState, WithANumberThatIsNonePassesNoBound) {
  constexpr double kAnything = std::numeric_limits<double>::max();
  for (ArrayXd* const field : {&q_, &s_, &u_}) {
    for (const Index cell : {kInner, kOuter, Index{16 + 3}}) {
      const double before = std::exchange((*field)[cell], kNaN);
      EXPECT_FALSE(certificate().gap <= kAnything);
      if (field == &q_) {
        EXPECT_FALSE(certificate().moment <= kAnything);
        EXPECT_FALSE(certificate().force <= kAnything);
        EXPECT_FALSE(certificate().friction_bound <= kAnything);
      }
      (*field)[cell] = before;
    }
  }
  ArrayXd none = ArrayXd::Zero(16);
  bound_.swap(none);  // traction without friction
  EXPECT_FALSE(certificate().friction_bound <= kAnything);
  bound_.swap(none);
  bound_[kOuter] = kNaN;
  EXPECT_FALSE(certificate().gap <= kAnything);
  EXPECT_FALSE(certificate().friction_bound <= kAnything);
}

/// With no energy a gap has nothing to be relative to, and must not pass either.
TEST_F(CoulombState, WithoutEnergyButWithAGapPassesNoBound) {
  q_.setZero();
  u_.setZero();
  s_.setConstant(0.1);
  EXPECT_FALSE(certificate().gap <= 1e300);
}

// --- the gap as a bound ---

/// A minimum of q.Kq/2 - phi t.q over the friction discs of 6 x 6 cells.
class SmallProblem : public testing::Test {
 protected:
  static constexpr double kTwist = 0.5;

  SmallProblem() {
    const ArrayXd r2 = cell_x1(grid_).square() + cell_x2(grid_).square();
    bound_ = (1.0 - r2 / 12.0).max(0.0).sqrt() * 0.9;
    const TangentialProblem problem{.friction_bound = bound_, .twist = kTwist};
    q_star_ = example::solve_by_plain_gradient(op_, problem, 1e-16, 5000).traction;
    moment_ = (q_star_ * t_).sum();
  }

  ArrayXd product(const ArrayXd& q) const { return (K_ * q.matrix()).array(); }
  double energy(const ArrayXd& q) const { return 0.5 * (q * product(q)).sum(); }

  ArrayXd project(const ArrayXd& q) const { return q * (bound_ / norms(q).max(1e-300)).min(1.0).replicate(2, 1); }

  ArrayXd random_feasible(std::mt19937_64& generator) const {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const ArrayXd noise = ArrayXd::NullaryExpr(72, [&] { return uniform(generator); });
    return project(noise * bound_.replicate(2, 1));
  }

  Certificate certify_at(const ArrayXd& q, double twist) const {
    const ArrayXd u = product(q);
    const ArrayXd s = u - twist * t_;
    return certify({q, u, s}, bound_, t_, moment_, {}, law_.least_eigenvalue(grid_.h1, grid_.h2));
  }

  Grid grid_{6, 6, 1.0, 1.0};
  ArrayXd t_ = rotation_field(grid_);
  HalfSpaces law_{elastic_pair({1.0, 0.3}, {2.5, 0.1})};
  DenseMatrix op_{grid_, tangential_kernel(), law_};
  const Eigen::MatrixXd& K_ = op_.matrix();
  ArrayXd bound_, q_star_;
  double moment_ = 0.0;
};

TEST_F(SmallProblem, HasPartialSlipAndItsMinimumHasNoGap) {
  const ArrayXd size = norms(q_star_);
  const Index contact = (bound_ > 0.0).count();
  const Index slipping = (bound_ > 0.0 && size >= bound_ * (1.0 - 1e-12)).count();
  EXPECT_GT(slipping, 4);
  EXPECT_LT(slipping, contact - 4);
  const Certificate c = certify_at(q_star_, kTwist);
  EXPECT_LE(std::abs(c.gap), 1e-11);
  EXPECT_LE(c.friction_bound, kFewRoundings);
}

/// energy(q) - energy(q*) among tractions of one moment, bounded from both sides whatever the twist that is put in.
TEST_F(SmallProblem, GapBoundsTheEnergyErrorOfAnyFeasibleTraction) {
  std::mt19937_64 generator(20);
  const double least = energy(q_star_);
  const ArrayXd full = bound_.replicate(2, 1) * t_ / norms(t_).replicate(2, 1);  // the limit moment's
  for (const double closeness : {0.0, 0.9, 0.99, 0.9999}) {
    for (int i = 0; i < 25; ++i) {
      const ArrayXd start = random_feasible(generator);
      // The discs are convex: between a traction of less moment and one of more lies one with M.
      const double of_start = (start * t_).sum();
      const double of_full = (full * t_).sum();
      ASSERT_LT(of_start, moment_);
      ASSERT_GT(of_full, moment_);
      const double part = (moment_ - of_start) / (of_full - of_start);
      const ArrayXd q = closeness * q_star_ + (1.0 - closeness) * ((1.0 - part) * start + part * full);
      ASSERT_NEAR((q * t_).sum(), moment_, 1e-12);

      const double error = energy(q) - least;
      const double distance = energy(q - q_star_);
      EXPECT_LE(distance, error + 1e-12);
      for (const double twist : {0.0, 0.5 * kTwist, kTwist, 1.3 * kTwist}) {
        const Certificate c = certify_at(q, twist);
        EXPECT_LE(error, c.energy_error * energy(q) + 1e-12);
        EXPECT_LE(c.energy_error, c.gap + kFewRoundings);
        EXPECT_GE(c.gap, 0.0);
        EXPECT_LE(c.friction_bound, kFewRoundings);
      }
    }
  }
}

// --- slip direction ---

class LeastEigenvalue : public testing::TestWithParam<std::tuple<double, double>> {};
INSTANTIATE_TEST_SUITE_P(Cells, LeastEigenvalue,
                         testing::Combine(testing::Values(0.05, 0.5, 1.0, 2.0, 20.0),
                                          testing::Values(-0.9, 0.0, 0.3, 0.5)));

TEST_P(LeastEigenvalue, IsBelowThoseOfAMatrixAndNotFarBelow) {
  const auto [h2, poisson_ratio] = GetParam();
  const HalfSpaces law(elastic_pair({2.0, poisson_ratio}, {2.0, poisson_ratio}));
  const DenseMatrix matrix({12, 12, 1.0, h2}, tangential_kernel(), law);
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix.matrix()).eigenvalues()[0];
  EXPECT_LT(law.least_eigenvalue(1.0, h2), least);
  EXPECT_GT(law.least_eigenvalue(1.0, h2), 0.7 * least);
}

TEST(SlipDirection, IsTheAngleFromTheReverseOfTraction) {
  ArrayXd q = ArrayXd::Zero(8);
  ArrayXd s = ArrayXd::Zero(8);
  EXPECT_EQ(slip_direction(q, s).mean, 0.0);
  q << 1, 1, 1, 1, 0, 0, 0, 0;
  s << -3, 0, 0, 0, 0, 0, 0, 0;
  EXPECT_EQ(slip_direction(q, s).mean, 0.0);
  s << -3, 0, 0, 0, 0, 1, 0, 0;  // a right angle where a quarter of the slip is
  EXPECT_NEAR(slip_direction(q, s).mean, 90.0 / 4.0, 1e-12);
  EXPECT_NEAR(slip_direction(q, s).max, 90.0, 1e-12);
  s << -3, 0, 1e-3, 0, 0, 0, 0, 0;  // the wrong way round, but hardly at all
  EXPECT_NEAR(slip_direction(q, s).mean, 180.0 * 1e-3 / 3.001, 1e-12);
  EXPECT_EQ(slip_direction(q, s).max, 0.0);
  s[1] = kNaN;
  EXPECT_FALSE(slip_direction(q, s).mean <= 180.0);
  EXPECT_FALSE(slip_direction(q, s).max <= 180.0);
}

TEST(Beyond, NamesTheMemberItsValueAndItsBound) {
  const CertificateBounds bounds{.gap = 1e-8, .moment = 1e-9, .force = 1e-10, .friction_bound = 1e-11};
  const Certificate holds{.gap = 1e-8,
                          .energy_error = 0.0,
                          .rounding = 0.0,
                          .moment = 1e-9,
                          .force = 1e-10,
                          .friction_bound = -0.1,
                          .energy = 1.0};
  EXPECT_EQ(violated_bounds(holds, bounds), "");
  const struct {
    double Certificate::*member;
    const char* name;
  } members[] = {{&Certificate::gap, "gap / energy"},
                 {&Certificate::moment, "the moment's error"},
                 {&Certificate::force, "the force's error"},
                 {&Certificate::friction_bound, "|q| above its bound"}};
  for (const auto& [member, name] : members) {
    for (const double value : {2e-8, kNaN, HUGE_VAL}) {
      Certificate fails = holds;
      fails.*member = value;
      EXPECT_THAT(violated_bounds(fails, bounds), testing::HasSubstr(name));
      EXPECT_THAT(violated_bounds(fails, bounds), testing::HasSubstr("allowed: 1e-"));
      EXPECT_THAT(violated_bounds(fails, bounds), testing::HasSubstr(fmt::format("{:.3g}", value)));
    }
  }
  Certificate nothing_asked = holds;
  nothing_asked.gap = kNaN;
  EXPECT_NE(violated_bounds(nothing_asked, {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL}), "") << "NaN never holds";
}

}  // namespace
}  // namespace slipstick::solver
