#include "solver/contact/anderson.hpp"

#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

using Eigen::ArrayXd;

void Anderson::advance(ArrayXd& x, const ArrayXd& residual, double step) {
  if (last_.x.size() > 0) changes_.push_front({x - last_.x, residual - last_.residual});
  if (changes_.size() > static_cast<std::size_t>(depth_)) changes_.pop_back();
  last_ = {x, residual};
  x += step * residual;

  const auto count = static_cast<Index>(changes_.size());
  CoefficientMatrix products(count, count);
  Coefficients right(count);
  for (Index i = 0; i < count; ++i) {
    const ArrayXd& change = changes_[static_cast<std::size_t>(i)].residual;
    right[i] = (change * residual).sum();
    for (Index j = 0; j < count; ++j) {
      products(i, j) = (change * changes_[static_cast<std::size_t>(j)].residual).sum();
    }
  }
  const Coefficients back = least_solution(products, right);
  if (!back.allFinite()) return;
  for (Index i = 0; i < count; ++i) {
    const Point& change = changes_[static_cast<std::size_t>(i)];
    x -= back[i] * (change.x + step * change.residual);
  }
}

}  // namespace slipstick::solver
