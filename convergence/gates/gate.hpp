#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "convergence/results/result_parts.hpp"

/// A gate holds one number of a result to a bound, or compares it with a published number.
namespace slipstick::convergence {

/// low < x < high.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
/// |x| < size.
struct Below {
  double size;
};
/// The value is this word or this number.
struct Equals {
  Json value;
};
/// |x - y| < within |y|, where y is the same quantity of another result, scene or study.
struct RelativeTo {
  std::filesystem::path file;
  double within;
};

/// A number as it is printed in a publication.
struct PrintedNumber {
  std::string text;
  double value = 0.0;
  double half_unit = 0.0;  ///< half a unit of the last digit; a fraction is exact: 0.5e-12 of its value
};

/// How a published number compares with ours. Undecided: our own error is larger than half a unit of the last
/// printed digit.
enum class Comparison { agrees, differs, undecided, not_compared };
std::string to_string(Comparison comparison);

/// The number is a published one, within half a unit of its last digit and our own error.
struct Published {
  PrintedNumber number;
  std::string source;                        ///< author, year, title, table or equation, page
  std::string seen;                          ///< the text in which we read it
  double argument_error = 0.0;               ///< error of the number by the digits of its argument
  double times = 1.0;                        ///< the published number is `times` x ours,
  bool inverse = false;                      ///< or `times` over ours
  std::optional<double> relative_error;      ///< of our number, where the result states none
  Comparison expected = Comparison::agrees;  ///< as the gate file says
  std::string why;                           ///< reason, where another outcome than agreement is expected
};

using Bound = std::variant<Below, Interval, Equals, RelativeTo, Published>;

/// A scene that is solved. overrides: "key=value", as --set takes them.
struct SceneSource {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  auto operator<=>(const SceneSource&) const = default;
};
/// A study that is run.
struct StudySource {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  auto operator<=>(const StudySource&) const = default;
};
/// A result file (JSON) of any program.
struct ResultSource {
  std::filesystem::path file;
  std::filesystem::path folder;  ///< of --results; empty: the file lies in the gate file's folder
  std::string made_by;           ///< command that writes the file; empty: unknown
  auto operator<=>(const ResultSource&) const = default;
};
/// No source: the gate has a published number that is not compared.
using GateSource = std::variant<std::monostate, SceneSource, StudySource, ResultSource>;

/// The file of a source; empty for none.
std::filesystem::path file_of(const GateSource& source);

/// An active gate must hold. An expected failure must not hold, so that its entry goes when the defect goes.
/// A reported gate has no effect on the exit code.
enum class GateStatus { active, expected_failure, report_only };

/// One gate of a gate file.
struct Gate {
  std::filesystem::path file;  ///< gate file
  std::size_t line = 0;
  std::string id;
  GateSource source;
  std::string quantity;  ///< path into the result, as in steps[3].traction_error.l2; empty: gate file unreadable
  Bound bound = Below{};
  double platform_spread = 0.0;  ///< difference between machines and compilers, in the quantity's unit
  std::string basis;             ///< origin of the bound
  std::string reason;            ///< why the number matters
  GateStatus status = GateStatus::active;
};

/// The verdict on a gate. Refused: it could not be judged.
enum class Outcome { passed, failed, failed_as_expected, passed_unexpectedly, reported, refused };
std::string to_string(Outcome outcome);

/// A gate and its verdict.
struct Judgement {
  Gate gate;
  Outcome outcome = Outcome::refused;
  Json value;                        ///< null: the result has none
  std::optional<Interval> interval;  ///< allowed numbers; none for a word, or while the other result is unknown
  double own_error = 0.0;            ///< error of `value` in its unit, known for published numbers
  double factor = 0.0;               ///< distance from the bound: 1 is at the bound, infinite where no number is
  std::string why;                   ///< one sentence; empty where it passed
  std::string dominant_error;        ///< largest part of the error budget; empty: unknown
  double seconds = 0.0;              ///< of the result; zero where an earlier gate has the same source
  std::string file_date;             ///< last change of a result file (UTC); empty for other sources
};

/// The width of a gate over the error of the exact answer and the spread of platforms is at least this:
/// a narrower gate judges the reference or the machine.
inline constexpr double kGateMargin = 10.0;

/// Whether a quantity is an error against an exact answer, or follows from one: its path says so.
bool is_error(const std::string& quantity);

/// The relative error of the exact answer that a quantity is compared with: exact.relative_uncertainty or
/// reference_uncertainty in the innermost object around the quantity that has one of them. Zero for a
/// quantity that is no error; NaN for an error whose reference states none.
double reference_error(const Json& result, const std::string& quantity);

/// Judges a gate; other: the result to which its bound is relative, else nullptr.
///   1. a solve that died, or a study with failed runs, fails a gate of any status;
///   2. a gate narrower than kGateMargin allows is refused; a result file need not state its reference's
///   error;
///   3. a number that is missing, NaN or of a solve that did not reach its tolerance does not hold;
///   4. the gate's status makes an outcome of it.
/// A published number is compared thus:
///   1. Our own error is `own_error` of the gate file, or the result states it next to the number
///      (`uncertainty`) or in an object around it (relative_uncertainty).
///   2. The numbers agree within half a unit of the last printed digit + argument_error + our own error.
///   3. Where our own error is larger than the other two, agreement shows nothing: the outcome is `reported`
///      if the gate file says undecided, else `refused`.
/// Throws InputError where the other result has no number, has zero, or did not reach its tolerance; and where no
/// error of our number is known that is compared with a published one.
Judgement judge(const Gate& gate, const Json& result, const Json* other = nullptr);

/// The row of a judgement in the result of a command: docs/schema/gate.schema.json (gate_report.cpp).
void to_json(Json& json, const Judgement& judgement);

/// The judgement of a gate that cannot be judged.
Judgement refuse(const Gate& gate, const std::string& why);

/// 0: every active gate holds and every expected failure fails. 2: no gate was judged, or one was refused. 1:
/// otherwise.
int exit_code(const std::vector<Judgement>& judgements);

/// The bound for a person: "below 2e-05 in size".
std::string bound_text(const Judgement& judgement);

/// The command that judges this gate only.
std::string rerun_command(const Gate& gate);

/// Value and last digit of a text such as 1.0760, 8.155e-3 or 2/3; none for another text.
std::optional<PrintedNumber> read_printed(const std::string& text);

/// How the numbers compare; none where something is wrong, or the gate has no published number.
std::optional<Comparison> comparison_of(const Judgement& judgement);

/// Our number in the unit of the publication.
struct OwnNumber {
  double value;
  double error;       ///< in the same unit
  double half_units;  ///< the error over half a unit of the last printed digit
};
/// None where the result has no number.
std::optional<OwnNumber> own_number(const Judgement& judgement);

/// The published number and ours: {text, value, half_unit, source, seen, argument_error, comparison, ours,
/// own_error, own_error_half_units, deviation, differs, undecided, not_compared}; deviation is ours minus the
/// published number, over half_unit.
Json published_json(const Judgement& judgement);

}  // namespace slipstick::convergence
