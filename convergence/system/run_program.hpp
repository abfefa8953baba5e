#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The one way in which other programs are started: by posix_spawn(), without a shell. Builds with
/// SLIPSTICK_PORTABLE start none: Program throws std::runtime_error, run_program() says that none was
/// started.
namespace slipstick::convergence {

/// What a program writes on standard output, or there and on standard error, comes back to who started it.
/// The rest goes where this program's own goes.
enum class Captured { nothing, output, everything };

struct ProgramOptions {
  Captured captured = Captured::nothing;
  bool fed = false;  ///< its standard input is what feed() gives; else this program's own
  /// The slipstick program, through which another is started that must not outlive this process, however that
  /// ends: on Linux the kernel kills it then. Elsewhere, or where this is empty, it is only of this process's
  /// group, so that what reaches the group ends it too.
  std::filesystem::path tied_by = {};
  std::filesystem::path folder = {};  ///< that it runs in; empty: this program's own
  /// It leads a process group of its own, which wait_at_most() kills as a whole. On Linux, where it is tied
  /// too, no process that it started, whichever group or session that went to, outlives it.
  bool own_group = false;
};

/// How a program ended.
struct ProgramEnd {
  int code = -1;  ///< -1: it was not started, was killed, or nobody is told, as under an ignored SIGCHLD
  bool started = true;
  std::string output;        ///< what was captured
  double cpu_seconds = 0.0;  ///< user and system, of it and of what it waited for
  std::string trouble;       ///< what speaks against its success, after its name; empty: it ended with 0
};

/// A program that runs. Who leaves it before it has ended kills it.
class Program {
 public:
  /// words: the program, looked for on PATH where its name has no slash, and its arguments. Throws
  /// std::runtime_error where there is no pipe.
  explicit Program(const std::vector<std::string>& words, const ProgramOptions& options = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// The descriptor that is ready when there is more captured output, or its end; -1: nothing is captured.
  int output() const { return output_; }

  /// Waits for more captured output. Returns whether that was all.
  bool read_on();

  /// What was captured so far.
  const std::string& captured() const { return end_.output; }
  void forget_captured() { end_.output.clear(); }

  /// Writes to its standard input; in vain where it has ended. Then no more will come.
  void feed(std::string_view text);
  void end_feed() { close_descriptor(input_); }

  /// Waits for its end.
  ProgramEnd wait();

  /// Waits for its end, so many seconds at most: then it is killed, with its group. The last `kept` bytes of
  /// what it says are kept.
  ProgramEnd wait_at_most(double seconds, std::size_t kept);

 private:
  static void close_descriptor(int& descriptor);
  /// Whether it has ended, without waiting where `wait` is false; then end_ says how.
  bool reap(bool wait);
  /// Kills it, with its group.
  void stop();

  int process_ = -1;
  int input_ = -1;
  int output_ = -1;
  bool own_group_ = false;
  bool guarded_ = false;
  ProgramEnd end_;
};

/// Starts a program and waits for its end.
ProgramEnd run_program(const std::vector<std::string>& words, const ProgramOptions& options = {});

/// What the slipstick program does first where it was started as another's `tied_by`: binds itself to the
/// life of that process, and becomes the program that was asked for unless that is itself. The words that
/// said so are taken off.
void obey_tie(int& argc, char**& argv);

}  // namespace slipstick::convergence
