# A regression of 15 %: each application by convolution sleeps that part of the time that it took. Sleeps end late, by
# the 50 us of the kernel's timer slack and more, so the last tenth of a millisecond is spent waiting for the clock.
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/mutant.cmake")

mutant(sleeping_operator
  FILE solver/elasticity/convolution.cpp
  FIND [[  transform_.forward_rows(traction);]]
  REPLACE [[  struct Sleep {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Sleep() {
      const auto now = std::chrono::steady_clock::now();
      const auto end = now + std::chrono::duration_cast<std::chrono::nanoseconds>(0.15 * (now - start));
      std::this_thread::sleep_until(end - std::chrono::microseconds(100));
      while (std::chrono::steady_clock::now() < end) {
      }
    }
  };
  const Sleep at_the_end;
  transform_.forward_rows(traction);]])
