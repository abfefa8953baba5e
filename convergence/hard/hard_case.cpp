#include "convergence/hard/hard_case.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

using solver::SceneReader;

/// More in one file is a wrong list.
constexpr std::size_t kMaxCases = 100'000;

std::string unquoted(const std::string& value) {
  const bool quoted = value.size() > 1 && (value.front() == '"' || value.front() == '\'');
  return quoted ? value.substr(1, value.size() - 2) : value;
}

/// Each of some cases with each value of a key.
std::vector<HardCase> varied(const std::vector<HardCase>& cases, const std::string& key,
                             const std::vector<std::string>& values) {
  std::vector<HardCase> all;
  for (const HardCase& made : cases) {
    for (const std::string& value : values) {
      HardCase& one = all.emplace_back(made);
      if (!one.name.empty()) one.name += "-";
      one.name += unquoted(value);
      one.run.overrides.push_back(fmt::format("{}={}", key, value));
    }
  }
  return all;
}

std::vector<HardCase> read_family(SceneReader& reader, const std::string& at) {
  HardCase base;
  base.family = reader.text(at + "name");
  base.why = reader.text(at + "why");
  base.run.scene = reader.path(at + "scene").lexically_normal();
  base.run.overrides = reader.assignments(at + "set");
  std::vector<HardCase> cases{base};
  const std::size_t keys = reader.count(at + "vary");
  for (std::size_t i = 0; i < keys; ++i) {
    const std::string vary = fmt::format("{}vary[{}].", at, i);
    const std::string key = reader.text(vary + "key");
    const std::vector<std::string> values = reader.list(vary + "values");
    if (values.empty()) reader.fail(vary + "values", "(missing)", "a list of values");
    if (cases.size() * values.size() > kMaxCases) {
      reader.fail(vary + "values", fmt::format("{} cases", cases.size() * values.size()),
                  fmt::format("at most {}", kMaxCases));
    }
    cases = varied(cases, key, values);
  }
  return cases;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A converged answer balances its loads within this, relative: ten times the rounding of sums over 1e6 cells.
constexpr double kBalanced = 1e-8;
/// A stated uncertainty counts as at least this, relative, for rounding and the stopping test.
constexpr double kMinUncertainty = 1e-6;
/// Answers that differ by less agree.
constexpr double kAgree = 0.01;
/// Slip opposes traction where the mean angle between them, weighted by slip, is less: degrees.
constexpr double kOpposed = 1.0;
/// Below this gap over energy, turned slip is that of rounding and of the stopping test.
constexpr double kNoticed = 1e-6;

// ---------------------------------------------------------------- one record

/// The first member of the certificate that is above its bound; empty: none.
std::string broken_promise(const SolveRecord& record) {
  const CertificateRecord& certificate = record.end.certificate;
  const double rounding = certificate.rounding;
  const double allowed = std::max(record.problem.tolerance, std::isnan(rounding) ? 0.0 : rounding);
  if (record.problem.method != "paper" && !(certificate.gap <= allowed)) {
    return fmt::format("its gap is {:.3g}, above {:.3g}", certificate.gap.value, allowed);
  }
  for (const auto& [name, missed] : {std::pair<const char*, double>{"moment", certificate.moment},
                                     {"force", certificate.force},
                                     {"friction_bound", certificate.friction_bound}}) {
    if (!(missed <= kBalanced)) return fmt::format("certificate.{} is {:.3g}", name, missed);
  }
  return "";
}

/// The largest known error of the contact's motion and load.
double exact_error(const ErrorsRecord& errors) {
  double largest = kNaN;
  for (const double error : {errors.twist.value, errors.moment.value, errors.displacement.value}) {
    largest = std::fmax(largest, std::abs(error));
  }
  return largest;
}

/// Infinite where the record has a reason why it is not known; NaN where it states neither.
double stated_uncertainty(const Number& uncertainty) {
  if (!std::isnan(uncertainty)) return std::max(uncertainty.value, kMinUncertainty);
  return uncertainty.why_missing.empty() ? kNaN : std::numeric_limits<double>::infinity();
}

JudgedNumbers work_of(const SolveRecord& record) {
  const auto known = [](double value) { return number_or(value, "the result has none"); };
  const WorkRecord& work = record.end.work;
  JudgedNumbers numbers;
  numbers.operator_applications = known(work.operator_applications);
  numbers.pressure_applications = known(record.is_exact() ? kNaN : work.pressure_applications);
  numbers.seconds = known(work.seconds.total);
  numbers.slip_direction = known(record.method.slip_direction.mean);
  if (!record.is_exact()) numbers.safeguards = record.method.safeguards;
  return numbers;
}

// ---------------------------------------------------------------- two records

double or_zero(double size) { return std::isfinite(size) ? size : 0.0; }

/// The elastic energy; of an unloaded state the energy of its certificate.
double energy_of(const EndRecord& end) {
  return or_zero(std::fmax(end.energy.elastic, end.certificate.energy.value_or(Number())));
}

/// A number of two equivalent problems, and how the variants change it.
struct ComparedNumber {
  double (*value)(const EndRecord&);
  bool is_reversed;  ///< in a mirror, and with the bodies exchanged
  bool has_length;   ///< its unit has one power of a length
  /// The size to compare it with where it is zero, or would be without rounding.
  double (*natural_size)(const EndRecord&);
};

double no_size(const EndRecord&) { return 0.0; }
double twist_of(const EndRecord& end) { return end.loads.twist_angle; }
double moment_of(const EndRecord& end) { return end.loads.moment; }
double limit_of(const EndRecord& end) { return end.loads.moment_limit; }
double load_of(const EndRecord& end) { return end.contact.normal_load; }
double radius_of(const EndRecord& end) { return end.contact.contact_radius; }
double elastic_of(const EndRecord& end) { return end.energy.elastic; }

double natural_twist(const EndRecord& end) {
  return or_zero(energy_of(end) / limit_of(end)) + or_zero(end.loads.displacement.length() / radius_of(end));
}

double natural_moment(const EndRecord& end) {
  return or_zero(end.loads.force.length() * radius_of(end)) +
         or_zero(energy_of(end) * radius_of(end) / end.contact.approach);
}

constexpr std::array kComparedNumbers{
    ComparedNumber{twist_of, true, false, natural_twist}, ComparedNumber{moment_of, true, true, natural_moment},
    ComparedNumber{limit_of, false, true, no_size},       ComparedNumber{load_of, false, false, no_size},
    ComparedNumber{radius_of, false, true, no_size},      ComparedNumber{elastic_of, false, true, energy_of}};

/// Number of the variant / number of the scene itself.
double factor(const ComparedNumber& number, Variant variant) {
  constexpr double kMillimetres = 1e3;
  if (variant == Variant::mirrored || variant == Variant::exchanged) return number.is_reversed ? -1.0 : 1.0;
  return variant == Variant::in_other_units && number.has_length ? kMillimetres : 1.0;
}

/// Distance of two normal contacts.
double pressure_difference(const ContactRecord& contact, const ContactRecord& other) {
  double largest = 0.0;
  for (const auto number : {&ContactRecord::normal_load, &ContactRecord::contact_radius, &ContactRecord::approach,
                            &ContactRecord::peak_pressure}) {
    const double difference = std::abs(other.*number / contact.*number - 1.0);
    if (!std::isnan(contact.*number) && !(difference <= largest)) largest = difference;
  }
  return largest;
}

}  // namespace

const solver::SettingKeys& hard_keys() {
  using namespace solver;
  static const SettingKeys keys{
      {"family", KeyType::tables, "", kRequired, kAny, "Tables `[[family]]`: a scene with keys that vary."},
      {"family.name", KeyType::text, "", kRequired, kAny, "Names the family."},
      {"family.why", KeyType::text, "", kRequired, kAny, "The reason why it is hard."},
      {"family.scene", KeyType::file, "", kRequired, kAny, "Scene file (TOML), relative to this file."},
      {"family.set", KeyType::table, "", "none", kAny, "Keys of the scene that differ from its file."},
      {"family.vary", KeyType::tables, "", "none", kAny,
       "Tables `[[family.vary]]`: every combination of their values is a case."},
      {"family.vary.key", KeyType::text, "", kRequired, kAny, "The key of the scene that varies."},
      {"family.vary.values", KeyType::values, "", kRequired, kAny, "The values that it takes."}};
  return keys;
}

std::vector<HardCase> read_hard_cases(const std::filesystem::path& file) {
  SceneReader reader(file, {}, hard_keys());
  std::vector<HardCase> cases;
  const std::size_t families = reader.count("family");
  if (families == 0) reader.fail("family", "(missing)", "[[family]] tables");
  for (std::size_t i = 0; i < families; ++i) {
    for (HardCase& made : read_family(reader, fmt::format("family[{}].", i))) {
      cases.push_back(std::move(made));
    }
  }
  reader.reject_unknown();
  return cases;
}

std::string to_string(HardVerdict verdict) {
  constexpr std::array words{"certified", "refused", "not_converged", "wrong"};
  return words[static_cast<std::size_t>(verdict)];
}

JudgedCase judge_alone(const SolveRecord& record) {
  if (record.status == RunStatus::refused) {
    return record.message.empty() ? JudgedCase{HardVerdict::wrong, "refused without a reason", {}}
                                  : JudgedCase{HardVerdict::refused, record.message, {}};
  }
  if (record.is_failed()) return {HardVerdict::wrong, "it died: " + record.message, {}};
  JudgedNumbers numbers = work_of(record);
  if (!record.is_converged()) return {HardVerdict::not_converged, record.message, numbers};

  const double error = exact_error(record.end.errors);
  const double uncertainty = stated_uncertainty(record.end.resolution.uncertainty);
  numbers.error = number_or(error, "no exact answer is known");
  numbers.uncertainty = number_or(uncertainty, "no size: the stick area lies within a cell");
  numbers.gap = number_or(record.end.certificate.gap, "the result has none");
  if (const std::string broken = broken_promise(record); !broken.empty()) {
    return {HardVerdict::wrong, broken, numbers};
  }
  if (std::isnan(uncertainty)) return {HardVerdict::wrong, "it states no uncertainty", numbers};
  if (error > uncertainty) {
    return {HardVerdict::wrong, fmt::format("it is {:.3g} from the exact answer, and says {:.3g}", error, uncertainty),
            numbers};
  }
  return {HardVerdict::certified, "", numbers};
}

double main_value(const SolveRecord& record) {
  const LoadsRecord& loads = record.end.loads;
  const std::string& number = record.end.resolution.number;
  const double value = number == "twist_angle"    ? loads.twist_angle.value
                       : number == "moment"       ? loads.moment.value
                       : number == "displacement" ? loads.displacement.length()
                       : number == "force"        ? loads.force.length()
                                                  : kNaN;
  return value == 0.0 || record.end.resolution.absolute == 0.0 ? kNaN : value;
}

MeshReference judge_by_finer(double value, double absolute, double twice, double four_times) {
  const double error = std::abs(value - four_times);
  const double change = std::abs(twice - four_times);
  const bool claims_nothing = absolute >= std::abs(value);
  const double unit = 1.0 / std::abs(four_times);
  return {unit * error, unit * change, error <= absolute + change || (claims_nothing && std::isfinite(error))};
}

double same_answer(const SolveRecord& record) {
  constexpr double kSame = 1e-6;
  const double missing = record.end.loads.limit.factor - 1.0;
  return missing > 0.0 ? kSame + record.problem.tolerance / missing : kSame;
}

double variant_difference(const SolveRecord& record, const SolveRecord& seen, Variant variant) {
  double largest = 0.0;
  for (const ComparedNumber& number : kComparedNumbers) {
    const double first = number.value(record.end);
    const double second = number.value(seen.end);
    if (std::isnan(first) && std::isnan(second)) continue;
    const double expected = factor(number, variant) * first;
    const double scale = std::max({std::abs(expected), std::abs(second), number.natural_size(seen.end)});
    const double difference = scale > 0.0 ? std::abs(second - expected) / scale : 0.0;
    if (!(difference <= largest)) largest = difference;
    if (std::isnan(largest)) return largest;
  }
  return largest;
}

std::string to_string(MethodVerdict verdict) {
  constexpr std::array words{"agrees", "refused", "not_converged", "other_direction", "other_answer"};
  return words[static_cast<std::size_t>(verdict)];
}

ComparedAnswer compare_answer(const SolveRecord& certified, const SolveRecord& other) {
  const JudgedCase alone = judge_alone(other);
  if (alone.verdict == HardVerdict::refused) return {MethodVerdict::refused, alone.reason, {}};
  if (alone.verdict == HardVerdict::not_converged) {
    return {MethodVerdict::not_converged, alone.reason, alone.numbers};
  }
  const bool foreign = other.program.has_value();
  if (alone.verdict == HardVerdict::wrong && !(foreign && alone.numbers)) {
    return {MethodVerdict::other_answer, alone.reason, alone.numbers};
  }
  if (!certified.is_converged()) {
    return {MethodVerdict::other_answer, "there is no certified answer", alone.numbers};
  }
  JudgedNumbers numbers = *alone.numbers;
  const bool pressure = foreign && other.program->fields == "pressure";
  const double difference = pressure ? pressure_difference(certified.end.contact, other.end.contact)
                                     : variant_difference(certified, other, Variant::none);
  numbers.difference = number_or(difference, "a number is missing");
  // Another discretisation has another error, and promises no gap on this one.
  const double by_mesh = foreign ? std::fmax(certified.end.resolution.uncertainty, 0.0) : 0.0;
  if (!(difference <= kAgree + same_answer(certified) + by_mesh)) {
    return {MethodVerdict::other_answer, fmt::format("it differs by {:.2g} from the certified answer", difference),
            numbers};
  }
  const double direction = numbers.slip_direction;
  if (foreign && std::isnan(direction)) return {MethodVerdict::agrees, "", numbers};  // nothing slips
  if (!(direction <= kOpposed) && !(numbers.gap.value_or(Number()) <= kNoticed)) {
    return {MethodVerdict::other_direction,
            fmt::format("its slip is turned by {:.2g} degrees from the reverse of traction", direction), numbers};
  }
  return {MethodVerdict::agrees, "", numbers};
}

}  // namespace slipstick::convergence
