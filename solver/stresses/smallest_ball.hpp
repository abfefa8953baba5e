#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

namespace slipstick::solver {

/// The smallest ball that holds points of a space of D dimensions: Welzl (1991), "Smallest enclosing disks
/// (balls and ellipsoids)", on the few points that lay farthest from a ball of the others. Every point lies
/// within the radius up to a relative rounding of 1e-10.
template <int D>
class SmallestBall {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  /// At least one point.
  explicit SmallestBall(std::span<const Point> points) : active_{points.front()} {
    for (;;) {
      radius2_ = -1.0;
      enclose(active_.size());
      const Point* farthest = &points.front();
      for (const Point& point : points)
        if (distance2(point) > distance2(*farthest)) farthest = &point;
      if (!is_outside(*farthest) || active_.size() == points.size()) return;
      active_.insert(active_.begin(), *farthest);
    }
  }

  const Point& center() const { return center_; }
  double radius() const { return std::sqrt(radius2_); }

 private:
  double distance2(const Point& point) const { return (point - center_).squaredNorm(); }
  bool is_outside(const Point& point) const { return distance2(point) > (1.0 + 1e-10) * radius2_; }

  /// The ball of the first `size` active points whose sphere goes through the points of boundary_.
  void enclose(std::size_t size) {
    if (!boundary_.empty()) circumscribe();
    for (std::size_t i = 0; i < size && boundary_.size() <= D; ++i) {
      if (!is_outside(active_[i])) continue;
      boundary_.push_back(active_[i]);
      enclose(i);
      boundary_.pop_back();
    }
  }

  /// The smallest sphere through all of boundary_.
  void circumscribe() {
    const auto sides = static_cast<Eigen::Index>(boundary_.size()) - 1;
    Eigen::Matrix<double, D, Eigen::Dynamic, 0, D, D> side(D, sides);
    for (Eigen::Index i = 0; i < sides; ++i)
      side.col(i) = boundary_[static_cast<std::size_t>(i) + 1] - boundary_[0];
    const auto squares = (side.transpose() * side).eval();
    const Point to_center = side * squares.ldlt().solve(0.5 * squares.diagonal());
    center_ = boundary_[0] + to_center;
    radius2_ = to_center.squaredNorm();
  }

  std::vector<Point> active_, boundary_;
  Point center_ = Point::Zero();
  double radius2_ = -1.0;
};

}  // namespace slipstick::solver
