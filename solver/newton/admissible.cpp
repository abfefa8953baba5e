#include "solver/newton/admissible.hpp"

#include "solver/grid/packet.hpp"

namespace slipstick::solver {

using Eigen::ArrayXd;
using Eigen::ArrayXf;

using Pair = Packet::Vector;

/// One component of a field in two cells, and zero for a second one that is past the last.
template <typename Number>
Pair pair(const Number* from, bool both) {
  return Pair{static_cast<double>(from[0]), both ? static_cast<double>(from[1]) : 0.0};
}
static Pair both(double value) { return Pair{value, value}; }

/// Values next to each other in a row, of a field that is kept or worked out: the k-th pair of them.
template <typename Number>
struct KeptRow {
  const Number* from;
  Pair operator()(Index k, bool both_cells) const { return pair(from + k, both_cells); }
};
struct MotionRow {
  static constexpr std::array<double, 2> kOnes{1.0, 1.0};
  MotionField::Row row;
  Pair operator()(Index k, bool both_cells) const {
    return pair(&kOnes[0], both_cells) * both(row.constant) + both(row.slope) * pair(row.x + k, both_cells);
  }
};
static MotionRow row_of(const MotionField& motion, Index first) { return {motion.row(first)}; }
template <typename Number>
KeptRow<Number> row_of(const Eigen::Array<Number, Eigen::Dynamic, 1>& field, Index first) {
  return {field.data() + first};
}

template <int M, typename Direction>
LoadsAlong<M> PositivePressures::loads_along(const ArrayXd& y, const std::array<const Direction*, M>& w,
                                             const Eigen::Vector<double, M>& x,
                                             const std::array<const MotionField*, M>& c) const {
  static_assert(M == 1, "the approach is a pressure's only condition");
  return sweep_.sum<LoadsAlong<M>>([&](Index first, Index last, LoadsAlong<M>& sum) {
    Pair load{};
    Pair slope{};
    const Pair x_1 = both(x[0]);
    const auto direction = row_of(*w[0], first);
    const auto field = row_of(*c[0], first);
    const auto add = [&](Index i, bool both_cells) {
      const Pair along = direction(i - first, both_cells);
      const Pair p = pair(y.data() + i, both_cells) + x_1 * along;
      const Pair free = p > 0.0 ? field(i - first, both_cells) : both(0.0);
      load += free * p;
      slope += free * along;
    };
    Index i = first;
    for (; i + 1 < last; i += 2) add(i, true);
    if (i < last) add(i, false);
    sum.load[0] += load[0] + load[1];
    sum.slope(0, 0) += slope[0] + slope[1];
  });
}

void PositivePressures::project(ArrayXd& p) const {
  sweep_.each([&](Index first, Index last) {
    auto part = p.segment(first, last - first);
    part = part.max(0.0);
  });
}

double PositivePressures::gap(const ArrayXd& p, const ArrayXd& opening) const {
  const double lowest = sweep_
                            .sum<Lowest>([&](Index first, Index last, Lowest& least) {
                              for (Index i = first; i < last; ++i) least += {opening[i]};
                            })
                            .value;
  return sweep_.sum<double>([&](Index first, Index last, double& sum) {
    sum += (p.segment(first, last - first) * (opening.segment(first, last - first) - lowest)).sum();
  });
}

Index PositivePressures::linearise(const ArrayXd& z, double, const std::array<double, 2>&, TangentSpace& space) const {
  const auto changed = sweep_.sum<Index>([&](Index first, Index last, Index& count) {
    for (Index i = first; i < last; ++i) {
      const bool contact = z[i] > 0.0;
      count += (space.f1[i] != 0.0) != contact;
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
  sweep_.each_own([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      const double size = std::sqrt(q[i] * q[i] + q[i + n] * q[i + n]);
      if (!(size > bound_[i])) continue;
      const double factor = bound_[i] / size;
      q[i] *= factor;
      q[i + n] *= factor;
    }
  });
}

/// Both components of a vector in two cells.
using PairOfVectors = std::array<Pair, 2>;

/// The sums of LoadsAlong on the unit motions (1, 0), (0, 1) and (-x2, x1), two cells at a time, and their
/// derivatives along Directions directions; 0: along the unit motions themselves, where they are symmetric.
template <std::size_t Directions>
struct UnitLoadsOfPairs {
  std::array<Pair, 3> load{};
  std::array<std::array<Pair, 3>, Directions == 0 ? 3 : Directions> slope{};
  Pair potential{}, carried{}, square{};

  /// free: 1, or 0 in a cell that is none; z: y + sum of x_l w_l; turn: (-x2, x1).
  void add(Pair free, Pair bound, const PairOfVectors& z, const PairOfVectors& turn,
           const std::array<PairOfVectors, Directions>& w) {
    // P(z) = factor z, and its derivative takes out what is along z where that is cut to the bound.
    const Pair z_z = z[0] * z[0] + z[1] * z[1];
    const Pair bound_2 = bound * bound;
    const auto cut = z_z > bound_2;
    const Pair length_2 = cut ? z_z : both(1.0);
    const Pair length{std::sqrt(length_2[0]), std::sqrt(length_2[1])};
    const Pair factor = cut ? bound / length : free;
    const Pair along = cut ? factor / length_2 : both(0.0);
    add_loads({factor * z[0], factor * z[1]}, turn, load);
    const PairOfVectors out{along * z[0], along * z[1]};
    const PairOfVectors row1{factor - out[0] * z[0], -out[0] * z[1]};
    const PairOfVectors row2{row1[1], factor - out[1] * z[1]};
    const auto derivative = [&](const PairOfVectors& of) {
      return PairOfVectors{row1[0] * of[0] + row1[1] * of[1], row2[0] * of[0] + row2[1] * of[1]};
    };
    if constexpr (Directions == 0) {
      slope[0][0] += row1[0];
      slope[0][1] += row1[1];
      slope[1][1] += row2[1];
      add_loads(derivative(turn), turn, slope[2]);
    }
    for (std::size_t l = 0; l < Directions; ++l) add_loads(derivative(w[l]), turn, slope[l]);
    potential += cut ? bound * (length - both(0.5) * bound) : both(0.5) * z_z;
    carried += cut ? bound_2 : z_z;
    square += cut ? z_z : bound_2;
  }

  static void add_loads(const PairOfVectors& q, const PairOfVectors& turn, std::array<Pair, 3>& sums) {
    sums[0] += q[0];
    sums[1] += q[1];
    sums[2] += turn[0] * q[0] + turn[1] * q[1];
  }

  template <int Columns>
  void add_to(LoadsAlong<3, Columns>& sum) {
    if constexpr (Directions == 0) {
      slope[1][0] = slope[0][1];
      slope[0][2] = slope[2][0];
      slope[1][2] = slope[2][1];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<int>(k);
      sum.load[row] += load[k][0] + load[k][1];
      for (int l = 0; l < Columns; ++l) {
        const Pair part = slope[static_cast<std::size_t>(l)][k];
        sum.slope(row, l) += part[0] + part[1];
      }
    }
    sum.potential += potential[0] + potential[1];
    sum.carried += carried[0] + carried[1];
    sum.square += square[0] + square[1];
  }
};

template <int M, typename Direction>
LoadsAlong<M> FrictionDiscs::loads_along(const ArrayXd& y, const std::array<const Direction*, M>& w,
                                         const Eigen::Vector<double, M>& x,
                                         const std::array<const MotionField*, M>& c) const {
  constexpr bool kAlongMotions = std::is_same_v<Direction, MotionField>;
  constexpr std::size_t kFields = kAlongMotions ? 0 : M;
  const Index n = cells();
  Eigen::Matrix<double, 3, M> of_fields;
  Eigen::Matrix<double, 3, M> of_directions = Eigen::Matrix<double, 3, M>::Zero();
  for (int k = 0; k < M; ++k) {
    of_fields.col(k) = c[static_cast<std::size_t>(k)]->motion();
    if constexpr (kAlongMotions) of_directions.col(k) = w[static_cast<std::size_t>(k)]->motion();
  }
  const Eigen::Vector3d motion = of_directions * x;
  const auto sums = sweep_.sum<LoadsAlong<3, kAlongMotions ? 3 : M>>([&](Index first, Index last, auto& sum) {
    UnitLoadsOfPairs<kFields> part;
    std::array<MotionRow, 2> turns;
    std::array<MotionRow, 2> motions;
    std::array<std::array<const float*, 2>, kFields> rows;
    for (const std::size_t component : {0, 1}) {
      const Index start = first + static_cast<Index>(component) * n;
      turns[component] = {c[0]->row(start, Eigen::Vector3d::UnitZ())};
      motions[component] = {c[0]->row(start, motion)};
      if constexpr (!kAlongMotions) {
        for (std::size_t l = 0; l < M; ++l) rows[l][component] = w[l]->data() + start;
      }
    }
    std::array<PairOfVectors, kFields> directions;
    const auto add = [&](Index i, bool both_cells) {
      PairOfVectors z{pair(y.data() + i, both_cells), pair(y.data() + i + n, both_cells)};
      PairOfVectors turn;
      const Index k = i - first;
      for (const std::size_t component : {0, 1}) {
        turn[component] = turns[component](k, both_cells);
        if constexpr (kAlongMotions) z[component] += motions[component](k, both_cells);
        for (std::size_t l = 0; l < kFields; ++l) {
          directions[l][component] = pair(rows[l][component] + k, both_cells);
          z[component] += both(x[static_cast<int>(l)]) * directions[l][component];
        }
      }
      part.add(Pair{1.0, both_cells ? 1.0 : 0.0}, pair(bound_.data() + i, both_cells), z, turn, directions);
    };
    Index i = first;
    for (; i + 1 < last; i += 2) add(i, true);
    if (i < last) add(i, false);
    part.add_to(sum);
  });
  LoadsAlong<M> loads{of_fields.transpose() * sums.load, {}, sums.potential, sums.carried, sums.square};
  if constexpr (kAlongMotions)
    loads.slope = of_fields.transpose() * sums.slope * of_directions;
  else
    loads.slope = of_fields.transpose() * sums.slope;
  return loads;
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
  return sweep_.sum<double>([&](Index first, Index last, double& sum) {
    for (Index i = first; i < last; ++i) {
      double d1 = -slip[i] / k;
      double d2 = -slip[i + n] / k;
      const double size = std::sqrt((q[i] + d1) * (q[i] + d1) + (q[i + n] + d2) * (q[i + n] + d2));
      if (size > bound_[i]) {
        d1 = (q[i] + d1) * bound_[i] / size - q[i];
        d2 = (q[i + n] + d2) * bound_[i] / size - q[i + n];
      }
      sum -= slip[i] * d1 + slip[i + n] * d2 + 0.5 * k * (d1 * d1 + d2 * d2);
    }
  });
}

double FrictionDiscs::gap_rounding(const ArrayXd& slip, const ArrayXd& displacement, const ArrayXd* reference) const {
  const double sum = sweep_.sum<double>([&](Index first, Index last, double& part) {
    const Index count = last - first;
    const auto size = [&](const ArrayXd& v) {
      return (v.segment(first, count).square() + v.segment(first + cells(), count).square()).sqrt();
    };
    part += (bound_.segment(first, count) * (size(slip) + 2.0 * size(displacement))).sum();
    if (reference != nullptr) part += (bound_.segment(first, count) * size(*reference)).sum();
  });
  return kGapUnits * sum;
}

Index FrictionDiscs::linearise(const ArrayXd& z, double rho, const std::array<double, 2>& mean,
                               TangentSpace& space) const {
  const Index n = cells();
  const auto changed = sweep_.sum<Index>([&](Index first, Index last, Index& count) {
    for (Index i = first; i < last; ++i) {
      const double size = std::sqrt(z[i] * z[i] + z[i + n] * z[i + n]);
      const bool slip = size > bound_[i];
      count += slip != space.on_line(i);
      if (!slip) {
        space.set(i, true);
        continue;
      }
      const double f1 = -z[i + n] / size;
      const double f2 = z[i] / size;
      space.set_line(i, f1, f2, (size - bound_[i]) / (rho * bound_[i]), f1 * f1 * mean[0] + f2 * f2 * mean[1]);
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

template <int M>
using Motions = const std::array<const MotionField*, M>&;
template <int M>
using Tangents = const std::array<const ArrayXf*, M>&;
template <int M>
using Parts = const Eigen::Vector<double, M>&;
template LoadsAlong<1> PositivePressures::loads_along<1, MotionField>(const ArrayXd&, Motions<1>, Parts<1>,
                                                                      Motions<1>) const;
template LoadsAlong<1> PositivePressures::loads_along<1, ArrayXf>(const ArrayXd&, Tangents<1>, Parts<1>,
                                                                  Motions<1>) const;
template LoadsAlong<1> FrictionDiscs::loads_along<1, MotionField>(const ArrayXd&, Motions<1>, Parts<1>,
                                                                  Motions<1>) const;
template LoadsAlong<1> FrictionDiscs::loads_along<1, ArrayXf>(const ArrayXd&, Tangents<1>, Parts<1>, Motions<1>) const;
template LoadsAlong<2> FrictionDiscs::loads_along<2, MotionField>(const ArrayXd&, Motions<2>, Parts<2>,
                                                                  Motions<2>) const;
template LoadsAlong<2> FrictionDiscs::loads_along<2, ArrayXf>(const ArrayXd&, Tangents<2>, Parts<2>, Motions<2>) const;
template LoadsAlong<3> FrictionDiscs::loads_along<3, MotionField>(const ArrayXd&, Motions<3>, Parts<3>,
                                                                  Motions<3>) const;
template LoadsAlong<3> FrictionDiscs::loads_along<3, ArrayXf>(const ArrayXd&, Tangents<3>, Parts<3>, Motions<3>) const;
}  // namespace slipstick::solver
