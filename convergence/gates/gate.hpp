#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"
#include "solver/input/setting_key.hpp"

namespace slipstick::convergence {

/// A number that somebody else published, as a gate file says it.
struct Published {
  std::string text;        ///< as printed: its digits say how far it is known
  double value = 0.0;      ///< of the text
  double half_unit = 0.0;  ///< half a unit of its last digit; of a fraction, which is exact, of its twelfth
  std::string source;      ///< author, year, title, table or equation, page
  std::string seen;        ///< the text in which it was looked up, where that is another
  double argument_error = 0;             ///< what the printed digits of its argument leave open
  double times = 1.0;                    ///< the published number is this many times ours
  bool inverse = false;                  ///< or this over ours
  std::optional<double> relative_error;  ///< of our number, where the result states none
  double own_error = 0.0;                ///< of our number, in its unit; known once it is bounded
  std::string differs;                   ///< why ours is another; empty: it agrees
  std::string undecided;                 ///< why ours is not known to its digits; empty: it is
  std::string not_compared;              ///< why it cannot be compared; empty: it can
};

/// Number and digits of a text such as 1.0760, 8.155e-3 or 2/3; none for another.
std::optional<Published> read_printed(const std::string& text);

/// What follows from a gate: an active one must hold, an expected failure must not hold (so that the entry
/// goes when the defect goes), and a reported one decides nothing.
enum class GateStatus { active, expected_failure, report_only };

/// Where the number comes from: a solve, a study, or a result file of any program; or nowhere, where a
/// published number cannot be compared.
enum class GateSource { scene, study, result, none };

/// A number of a result with the bounds that it must keep, as a gate file says it.
struct Gate {
  std::filesystem::path file;  ///< where it stands
  std::size_t line = 0;
  std::string id;
  GateSource kind = GateSource::scene;
  std::filesystem::path source;          ///< scene, study (TOML) or result (JSON)
  std::filesystem::path results_folder;  ///< in which results were said to lie; empty: beside the gate file
  std::string made_by;                   ///< the command that writes the result; empty: not known
  std::vector<std::string> overrides;    ///< "key=value", as --set takes them
  std::string quantity;                  ///< path into the result, as in steps[3].traction_error.l2
  std::optional<double> below;           ///< alone: a bound on the size; with `above`: on the signed value
  std::optional<double> above;           ///< a bound on the signed value
  Json equals;                           ///< a word or a number; null: not asked
  std::filesystem::path of;            ///< result, scene or study whose number this one is to be; empty: none
  double within = 0.0;                 ///< of the size of that number: how far from it this one may be
  std::optional<Published> published;  ///< number of the literature that this one is to be; empty: none
  double platform_spread = 0.0;        ///< by how much machines and compilers differ, in the quantity's unit
  std::string basis;                   ///< where the bound comes from
  std::string reason;                  ///< why the number matters
  GateStatus status = GateStatus::active;
};

/// The verdict on a gate. Refused: it could not be judged.
enum class Outcome { passed, failed, failed_as_expected, passed_unexpectedly, reported, refused };
std::string to_string(Outcome outcome);

/// A gate with what was found.
struct Judgement {
  Gate gate;
  Outcome outcome = Outcome::refused;
  Json value;  ///< null: the result has none
  double factor =
      0.0;          ///< of the bound that the value reaches: 1 is at the bound; infinite where no number says
  std::string why;  ///< one sentence; empty where it passed
  std::string dominant_error;  ///< the largest part of the error budget; empty: not known
  double seconds = 0.0;        ///< that the result took; zero where an earlier gate looks at the same result
  std::string file_date;       ///< day of the last change of a result file (UTC); empty for others
};

/// A gate needs this many times the error of what it is judged by: less, and a verdict says as much about the
/// reference, or about the machine, as about the program.
inline constexpr double kGateMargin = 10.0;

/// Whether a quantity is the error of another, against an exact answer, or follows from one: by its path.
bool is_error(const std::string& quantity);

/// How wrong the exact answer is that a quantity is compared with, relative: what stands in the result beside
/// the quantity, or beside what contains it, as exact.relative_uncertainty or reference_uncertainty. Zero for
/// what is no error; NaN for an error whose reference does not say.
double reference_error(const Json& result, const std::string& quantity);

/// Judges a gate by the result of its scene or study, or by what its result file holds. A number that is
/// missing, NaN or comes from a solve that did not reach its tolerance fails; a gate that is tighter than
/// kGateMargin allows is refused. A solve that died, or a study some of whose runs failed, fails a gate of
/// any status: that is neither the failure that was expected nor a number to report. In a result file the
/// reference's error counts where the file states one: the file may call anything an error, such as a count
/// of benchmarks that failed.
Judgement judge(const Gate& gate, const Json& result);

/// The gate with the bounds that `within` allows around what the other result has. Throws InputError where
/// that is no number, zero, or of a solve that did not reach its tolerance.
Gate bounded_by(Gate gate, const Json& other);

/// A gate that cannot be judged, and why.
Judgement refuse(const Gate& gate, const std::string& why);

/// 0: every active gate holds and no expected failure passes. 2: nothing was judged, or something could not
/// be. 1: else.
int exit_code(const std::vector<Judgement>& judgements);

/// The bound in words: "below 2e-05 in size".
std::string bound_text(const Gate& gate);

/// The command that runs it alone.
std::string rerun_command(const Gate& gate);

// ---------------------------------------------------------------- gate files (gate_reader.cpp)

/// Every key that a gate file may have; read_gates() reads by it.
const solver::SettingKeys& gate_keys();

/// The gates of several files, and what is wrong with those that cannot be read: one bad file does not
/// spoil the others.
struct GateFiles {
  std::vector<Gate> gates;
  std::vector<Judgement> unreadable;  ///< refused; the id is the file's name
};

/// The gates of a file (TOML: tables headed [[gate]], or [[group.gate]] below the keys that they share), in
/// the order of their lines. Paths in it are relative to its folder, those of results to `results_folder`,
/// unless that is empty. Throws InputError naming file, key, value and what is allowed.
std::vector<Gate> read_gates(const std::filesystem::path& file,
                             const std::filesystem::path& results_folder = {});

/// The gates of several files, in their order. A file that uses an id a second time counts as unreadable.
GateFiles read_gate_files(const std::vector<std::string>& files,
                          const std::filesystem::path& results_folder = {});

/// Those whose id is among `ids`; all where that is empty. Throws InputError for an id that no gate has,
/// naming the nearest.
std::vector<Gate> select_gates(const std::vector<Gate>& gates, const std::vector<std::string>& ids);

// ---------------------------------------------------------------- their runs (gate_run.cpp)

/// Computes what gates ask for, all scenes side by side and equal ones once, or reads it, and judges it. A
/// gate whose scene, study or result cannot be read is refused; the others are judged all the same.
std::vector<Judgement> run_gates(const std::vector<Gate>& gates, const ProcessPool& pool);

/// The gates, and after them those that others are relative to, as gates of their own, in the same order.
std::vector<Gate> with_others(const std::vector<Gate>& gates);

/// The runs whose results these gates are judged by; where one fails, the parts of its error take some more.
/// What cannot be read is left to run_gates().
std::vector<PreparedRun> gate_runs(const std::vector<Gate>& gates, const ProcessPool& pool);

// ---------------------------------------------------------------- published numbers (published.cpp)

/// Judges a published number. It agrees within half a unit of the last printed digit, what the digits of the
/// argument leave open, and our own error, as the result states it beside the number (`uncertainty`, or
/// relative_uncertainty in what contains it). Where our own error is larger than what digits and argument
/// leave open, nothing agrees: the number differs by more than that, or is undecided, which is reported where
/// the gate says so (`undecided`) and refused otherwise. Throws InputError where the result states no error.
Judgement judge_published(Gate gate, const Json& result);

/// The outcome in words: agrees, differs, undecided (it cannot be compared at its digits), not compared;
/// empty where something is wrong, or the gate has no published number.
std::string published_outcome(const Judgement& judgement);

/// The number beside ours, in its own unit: {text, value, half_unit, source, seen, argument_error,
/// comparison, ours, own_error, own_error_half_units, deviation, differs, undecided, not_compared}; deviation
/// is ours minus the published number, over half_unit.
Json published_json(const Judgement& judgement);

// ---------------------------------------------------------------- what became of them (gate_report.cpp)

/// For a person: a line a gate, then what there is to know of each that does not pass, and the count.
std::string gates_text(const std::vector<Judgement>& judgements);

/// JUnit's XML, as CI servers read it: a suite a file, a case a gate. Refused gates are errors; reported and
/// expected failures are skipped.
std::string gates_junit(const std::vector<Judgement>& judgements);

/// A Markdown table, the worst first, shorter than kMaxMarkdown bytes: what does not fit is counted.
std::string gates_markdown(const std::vector<Judgement>& judgements);

/// Every gate with value, bound, factor, outcome, and the counts.
Json gates_json(const std::vector<Judgement>& judgements);

}  // namespace slipstick::convergence
