#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Other programs are started only here: by posix_spawn(), without a shell. Builds with SLIPSTICK_PORTABLE
/// start none: Program throws std::runtime_error, and the end that run_program() returns has started = false.
namespace slipstick::convergence {

/// The streams of a started program that this process reads: standard output, or both output and error. The
/// other streams are inherited.
enum class Captured { nothing, output, everything };

struct ProgramOptions {
  Captured captured = Captured::nothing;
  bool fed = false;  ///< its standard input comes from feed(); else it is inherited
  /// The slipstick executable, which starts the program so that it cannot outlive this process: on Linux the
  /// kernel then kills it when this process ends for any reason. On other systems, or if empty, the program
  /// only shares this process's group, so a signal to the group ends it too.
  std::filesystem::path tied_by = {};
  std::filesystem::path folder = {};  ///< working folder; empty: inherited
  /// The program leads its own process group, which wait_at_most() kills as a whole. On Linux, with tied_by,
  /// all its descendants end with it, even those in another group or session.
  bool own_group = false;
};

/// How a program ended.
struct ProgramEnd {
  int code = -1;  ///< exit code; -1: not started, killed, or unavailable since SIGCHLD is ignored
  bool started = true;
  std::string output;        ///< of the captured streams
  double cpu_seconds = 0.0;  ///< user and system time of the program and of the children that it waited for
  std::string trouble;       ///< why it failed, a predicate as "was killed by signal 9"; empty: exit code 0
};

/// A started program. The destructor kills a process that is still running.
class Program {
 public:
  /// words: the program, searched on PATH if its name has no slash, and its arguments. Throws
  /// std::runtime_error if no pipe can be made.
  explicit Program(const std::vector<std::string>& words, const ProgramOptions& options = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Descriptor to poll: it is readable when there is more captured output, or its end. -1: nothing is captured.
  int output() const { return output_; }

  /// Waits for more captured output. Returns whether that was all.
  bool read_on();

  /// The output captured so far.
  const std::string& captured() const { return end_.output; }
  void clear_captured() { end_.output.clear(); }

  /// Writes to its standard input; does nothing if it has ended. end_feed() closes the input.
  void feed(std::string_view text);
  void end_feed() { close_descriptor(input_); }

  /// Waits for its end.
  ProgramEnd wait();

  /// Waits for its end, at most `seconds`: then it is killed, with its group. Only the last `kept` bytes of
  /// its output are kept.
  ProgramEnd wait_at_most(double seconds, std::size_t kept);

 private:
  static void close_descriptor(int& descriptor);
  /// Whether it has ended; waits for that if `wait`. Then fills end_.
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

/// Called first by main(). If this process was started by way of ProgramOptions::tied_by, it asks the kernel
/// to be killed when the parent ends, removes the words for this from the command line, and, unless the
/// program to be run is slipstick itself, becomes that program.
void die_with_parent(int& argc, char**& argv);

}  // namespace slipstick::convergence
