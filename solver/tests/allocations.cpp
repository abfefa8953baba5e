#include "solver/tests/allocations.hpp"

#include <atomic>
#include <cstddef>

namespace {
std::atomic<long> counted = 0;
}

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
void* __real_malloc(std::size_t size);
void* __real__Znwm(std::size_t size);
double* __real_fftw_alloc_real(std::size_t count);
float* __real_fftwf_alloc_real(std::size_t count);

void* __wrap_malloc(std::size_t size) {
  ++counted;
  return __real_malloc(size);
}
void* __wrap__Znwm(std::size_t size) {  // operator new
  ++counted;
  return __real__Znwm(size);
}
double* __wrap_fftw_alloc_real(std::size_t count) {
  ++counted;
  return __real_fftw_alloc_real(count);
}
float* __wrap_fftwf_alloc_real(std::size_t count) {
  ++counted;
  return __real_fftwf_alloc_real(count);
}
// NOLINTEND(bugprone-reserved-identifier)
}

long slipstick::solver::allocations() { return counted; }
