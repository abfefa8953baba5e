#include "solver/newton/admissible.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slipstick::solver {

using Eigen::ArrayXd;
using Eigen::ArrayXf;

template <int M, typename Direction>
LoadsAlong<M> PositivePressures::loads_along(const ArrayXd& y, const std::array<const Direction*, M>& w,
                                             const Eigen::Vector<double, M>& x,
                                             const std::array<const ArrayXd*, M>& c) const {
  static_assert(M == 1, "the approach is a pressure's only condition");
  const auto* const direction = w[0]->data();
  const double* const field = c[0]->data();
  return sweep_.sum<LoadsAlong<M>>([&](Index first, Index last, LoadsAlong<M>& sum) {
    double load = 0.0;
    double slope = 0.0;
    for (Index i = first; i < last; ++i) {
      const auto along = static_cast<double>(direction[i]);
      const double p = y[i] + x[0] * along;
      const double free = p > 0.0 ? field[i] : 0.0;
      load += free * p;
      slope += free * along;
    }
    sum.load[0] += load;
    sum.slope(0, 0) += slope;
  });
}

double PositivePressures::gap(const ArrayXd& p, const ArrayXd& opening) const {
  struct Lowest {
    double value = std::numeric_limits<double>::infinity();
    Lowest& operator+=(const Lowest& other) {
      if (!(other.value >= value)) value = other.value;
      return *this;
    }
  };
  const double lowest = sweep_
                            .sum<Lowest>([&](Index first, Index last, Lowest& least) {
                              for (Index i = first; i < last; ++i) least += {opening[i]};
                            })
                            .value;
  return sweep_.sum<double>([&](Index first, Index last, double& sum) {
    sum += (p.segment(first, last - first) * (opening.segment(first, last - first) - lowest)).sum();
  });
}

template <typename Real>
Index PositivePressures::linearise(const ArrayXd& z, double, const std::array<double, 2>&,
                                   TangentSpace<Real>& space) const {
  const auto changed = sweep_.sum<Index>([&](Index first, Index last, Index& count) {
    for (Index i = first; i < last; ++i) {
      const bool contact = z[i] > 0.0;
      count += (space.a11[i] != Real(0)) != contact;
      space.set(i, contact);
    }
  });
  space.find_free();
  return changed;
}

void PositivePressures::add_jump(const ArrayXd& z, const ArrayXd& p, ArrayXd& step) const {
  sweep_.each([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      if (!(z[i] > 0.0)) step[i] -= p[i];
    }
  });
}

void FrictionDiscs::project(ArrayXd& q) const {
  const Index n = cells();
  in_parts(ThreadPool::available(), n, [&](int, Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      const double size = std::sqrt(q[i] * q[i] + q[i + n] * q[i + n]);
      if (!(size > bound_[i])) continue;
      const double factor = bound_[i] / size;
      q[i] *= factor;
      q[i + n] *= factor;
    }
  });
}

template <int M, typename Direction>
LoadsAlong<M> FrictionDiscs::loads_along(const ArrayXd& y, const std::array<const Direction*, M>& w,
                                         const Eigen::Vector<double, M>& x,
                                         const std::array<const ArrayXd*, M>& c) const {
  const Index n = cells();
  std::array<const typename Direction::Scalar*, M> directions;
  std::array<const double*, M> fields;
  for (std::size_t k = 0; k < M; ++k) {
    directions[k] = w[k]->data();
    fields[k] = c[k]->data();
  }
  return sweep_.sum<LoadsAlong<M>>([&](Index first, Index last, LoadsAlong<M>& total) {
    LoadsAlong<M> sum;
    std::array<std::array<double, 2>, M> along{};
    std::array<std::array<double, 2>, M> weight{};
    for (Index i = first; i < last; ++i) {
      const double bound = bound_[i];
      double z1 = y[i];
      double z2 = y[i + n];
      for (std::size_t k = 0; k < M; ++k) {
        along[k] = {static_cast<double>(directions[k][i]), static_cast<double>(directions[k][i + n])};
        weight[k] = {fields[k][i], fields[k][i + n]};
        z1 += x[static_cast<int>(k)] * along[k][0];
        z2 += x[static_cast<int>(k)] * along[k][1];
      }
      // P(z) = factor z, and its derivative takes out what is along z where that is cut to the bound.
      const double square = z1 * z1 + z2 * z2;
      const bool cut = square > bound * bound;
      const double size = cut ? std::sqrt(square) : bound;
      const double factor = cut ? bound / size : 1.0;
      const double across = cut ? 1.0 / square : 0.0;
      for (std::size_t k = 0; k < M; ++k) {
        const auto row = static_cast<int>(k);
        const double c_z = weight[k][0] * z1 + weight[k][1] * z2;
        sum.load[row] += factor * c_z;
        for (std::size_t l = 0; l < M; ++l) {
          const double slope = weight[k][0] * along[l][0] + weight[k][1] * along[l][1] -
                               c_z * (along[l][0] * z1 + along[l][1] * z2) * across;
          sum.slope(row, static_cast<int>(l)) += factor * slope;
        }
      }
      sum.potential += cut ? bound * (size - 0.5 * bound) : 0.5 * square;
      sum.carried += std::min(square, bound * bound);
      sum.square += std::max(square, bound * bound);
    }
    total += sum;
  });
}

double FrictionDiscs::gap(const ArrayXd& q, const ArrayXd& slip) const {
  const Index n = cells();
  return sweep_.sum<double>([&](Index first, Index last, double& sum) {
    for (Index i = first; i < last; ++i) {
      sum += slip[i] * q[i] + slip[i + n] * q[i + n] +
             bound_[i] * std::sqrt(slip[i] * slip[i] + slip[i + n] * slip[i + n]);
    }
  });
}

double FrictionDiscs::energy_error(const ArrayXd& q, const ArrayXd& slip, double k) const {
  if (k == 0.0) return gap(q, slip);
  const Index n = cells();
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) {
    if (bound_[i] == 0.0) continue;
    double d1 = -slip[i] / k;
    double d2 = -slip[i + n] / k;
    const double size = std::sqrt((q[i] + d1) * (q[i] + d1) + (q[i + n] + d2) * (q[i + n] + d2));
    if (size > bound_[i]) {
      d1 = (q[i] + d1) * bound_[i] / size - q[i];
      d2 = (q[i + n] + d2) * bound_[i] / size - q[i + n];
    }
    sum -= slip[i] * d1 + slip[i + n] * d2 + 0.5 * k * (d1 * d1 + d2 * d2);
  }
  return sum;
}

double FrictionDiscs::gap_rounding(const ArrayXd& slip, const ArrayXd& displacement) const {
  constexpr double kUnits = 16.0;  // of transforms, and of loads, which are balanced to 1e-14
  const Index n = cells();
  const auto size = [n](const ArrayXd& v) { return (v.head(n).square() + v.tail(n).square()).sqrt(); };
  return kUnits * std::numeric_limits<double>::epsilon() *
         (bound_ * (size(slip) + 2.0 * size(displacement))).sum();
}

template <typename Real>
Index FrictionDiscs::linearise(const ArrayXd& z, double rho, const std::array<double, 2>& mean,
                               TangentSpace<Real>& space) const {
  const Index n = cells();
  const auto changed = sweep_.sum<Index>([&](Index first, Index last, Index& count) {
    for (Index i = first; i < last; ++i) {
      const double size = std::sqrt(z[i] * z[i] + z[i + n] * z[i + n]);
      const bool slip = size > bound_[i];
      count += slip != (space.stiffness[i] > Real(0));
      if (!slip) {
        space.set(i, true);
        continue;
      }
      const double f1 = -z[i + n] / size;
      const double f2 = z[i] / size;
      space.set_line(i, f1, f2, (size - bound_[i]) / (rho * bound_[i]),
                     f1 * f1 * mean[0] + f2 * f2 * mean[1]);
    }
  });
  if (space.free.count() != sweep_.count()) space.free = sweep_;  // none is held fast
  return changed;
}

void FrictionDiscs::add_jump(const ArrayXd& z, const ArrayXd& q, ArrayXd& step) const {
  const Index n = cells();
  sweep_.each([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      const double size = std::sqrt(z[i] * z[i] + z[i + n] * z[i + n]);
      if (!(size > bound_[i])) continue;
      const double e1 = z[i] / size;
      const double e2 = z[i + n] / size;
      const double jump = bound_[i] - (q[i] * e1 + q[i + n] * e2);
      step[i] += jump * e1;
      step[i + n] += jump * e2;
    }
  });
}

template LoadsAlong<1> PositivePressures::loads_along<1, ArrayXd>(const ArrayXd&,
                                                                  const std::array<const ArrayXd*, 1>&,
                                                                  const Eigen::Vector<double, 1>&,
                                                                  const std::array<const ArrayXd*, 1>&) const;
template LoadsAlong<1> PositivePressures::loads_along<1, ArrayXf>(const ArrayXd&,
                                                                  const std::array<const ArrayXf*, 1>&,
                                                                  const Eigen::Vector<double, 1>&,
                                                                  const std::array<const ArrayXd*, 1>&) const;
template LoadsAlong<1> FrictionDiscs::loads_along<1, ArrayXd>(const ArrayXd&,
                                                              const std::array<const ArrayXd*, 1>&,
                                                              const Eigen::Vector<double, 1>&,
                                                              const std::array<const ArrayXd*, 1>&) const;
template LoadsAlong<1> FrictionDiscs::loads_along<1, ArrayXf>(const ArrayXd&,
                                                              const std::array<const ArrayXf*, 1>&,
                                                              const Eigen::Vector<double, 1>&,
                                                              const std::array<const ArrayXd*, 1>&) const;
template LoadsAlong<2> FrictionDiscs::loads_along<2, ArrayXd>(const ArrayXd&,
                                                              const std::array<const ArrayXd*, 2>&,
                                                              const Eigen::Vector<double, 2>&,
                                                              const std::array<const ArrayXd*, 2>&) const;
template LoadsAlong<2> FrictionDiscs::loads_along<2, ArrayXf>(const ArrayXd&,
                                                              const std::array<const ArrayXf*, 2>&,
                                                              const Eigen::Vector<double, 2>&,
                                                              const std::array<const ArrayXd*, 2>&) const;
template LoadsAlong<3> FrictionDiscs::loads_along<3, ArrayXd>(const ArrayXd&,
                                                              const std::array<const ArrayXd*, 3>&,
                                                              const Eigen::Vector<double, 3>&,
                                                              const std::array<const ArrayXd*, 3>&) const;
template LoadsAlong<3> FrictionDiscs::loads_along<3, ArrayXf>(const ArrayXd&,
                                                              const std::array<const ArrayXf*, 3>&,
                                                              const Eigen::Vector<double, 3>&,
                                                              const std::array<const ArrayXd*, 3>&) const;
template Index PositivePressures::linearise(const ArrayXd&, double, const std::array<double, 2>&,
                                            TangentSpace<double>&) const;
template Index PositivePressures::linearise(const ArrayXd&, double, const std::array<double, 2>&,
                                            TangentSpace<float>&) const;
template Index FrictionDiscs::linearise(const ArrayXd&, double, const std::array<double, 2>&,
                                        TangentSpace<double>&) const;
template Index FrictionDiscs::linearise(const ArrayXd&, double, const std::array<double, 2>&,
                                        TangentSpace<float>&) const;

}  // namespace slipstick::solver
