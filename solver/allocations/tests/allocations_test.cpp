#include "solver/allocations/allocations.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

namespace {

TEST(Allocations, CountEveryWayToAllocate) {
  const long allocations = slipstick::solver::allocations();
  const long bytes = slipstick::solver::allocated_bytes();
  void* const one = ::operator new(8);  // which, unlike a new expression, compilers may not leave out
  void* const several = ::operator new[](80);
  void* volatile plain = malloc(100);
  void* volatile zeroed = calloc(3, 7);
  const long counted = slipstick::solver::allocations() - allocations;
  const long counted_bytes = slipstick::solver::allocated_bytes() - bytes;
  ::operator delete(one);
  ::operator delete[](several);
  free(plain);
  free(zeroed);
  EXPECT_EQ(counted, 4);
  EXPECT_EQ(counted_bytes, 8 + 80 + 100 + 21);
}

}  // namespace
