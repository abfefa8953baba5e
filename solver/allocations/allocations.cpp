#include "solver/allocations/allocations.hpp"

#include <fftw3.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> number = 0;
std::atomic<long> bytes = 0;

void count(std::size_t size) {
  ++number;
  bytes += static_cast<long>(size);
}

}  // namespace

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming): the linker's names
decltype(malloc) __real_malloc;
decltype(calloc) __real_calloc;
decltype(realloc) __real_realloc;
decltype(fftw_alloc_real) __real_fftw_alloc_real;
void* __real__Znwm(std::size_t size);
void* __real__Znam(std::size_t size);
void* __real__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment);

void* __wrap_malloc(std::size_t size) {
  count(size);
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t items, std::size_t size) {
  count(items * size);
  return __real_calloc(items, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  count(size);
  return __real_realloc(old, size);
}
void* __wrap__Znwm(std::size_t size) {  // operator new
  count(size);
  return __real__Znwm(size);
}
void* __wrap__Znam(std::size_t size) {  // operator new[]
  count(size);
  return __real__Znam(size);
}
void* __wrap__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment) {
  count(size);
  return __real__ZnwmSt11align_val_t(size, alignment);
}
double* __wrap_fftw_alloc_real(std::size_t reals) {
  count(reals * sizeof(double));
  return __real_fftw_alloc_real(reals);
}
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)
}

long slipstick::solver::allocations() { return number; }
long slipstick::solver::allocated_bytes() { return bytes; }
