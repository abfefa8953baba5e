# A regression of 15 % or a little more: each application by convolution sleeps that part of the time that it took.
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/mutant.cmake")

mutant(sleeping_operator
  FILE solver/convolution.cpp
  FIND [[  transform_.forward_rows(traction);]]
  REPLACE [[  struct Sleep {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Sleep() { std::this_thread::sleep_for(0.15 * (std::chrono::steady_clock::now() - start)); }
  };
  const Sleep at_the_end;
  transform_.forward_rows(traction);]])
