#include "analytic/certified/hardest.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>

#include "analytic/certified/certified.hpp"
#include "analytic/certified/reference_rows.hpp"
#include "analytic/references/replay.hpp"

namespace slipstick::analytic::certified {

namespace {

using testing::Row;

constexpr int kFileDigits = 30;

const std::vector<std::string> kProfiles{"hertz", "cone", "flat_punch"};

/// One input of a function; a radius for tractions, over the stick radius.
struct Input {
  double value;
  double fraction;
};

/// A function of the double path: what is given, and for tractions at which fraction of the stick radius.
struct Function {
  std::string given;
  bool traction;

  std::string file() const { return traction ? "traction.csv" : given + ".csv"; }
};

const std::vector<Function> kFunctions{{"moment_ratio", false},   {"moment_deficit", false},
                                       {"stick_ratio", false},    {"stick_complement", false},
                                       {"twist", false},          {"stick_ratio", true},
                                       {"stick_complement", true}};

double radius(const Function& function, const Input& input) {
  const double c = function.given == "stick_ratio" ? input.value : 1 - input.value;
  return c * input.fraction;
}

std::vector<ReferenceRow> rows(const std::string& profile, const Function& function, const Input& input) {
  if (function.traction)
    return {traction_row(profile, function.given, input.value, radius(function, input), kFileDigits)};
  return state_rows(profile, function.given, input.value, kFileDigits);
}

Row as_row(const ReferenceRow& row) {
  static const std::vector<std::string> kColumns{"profile", "given",     "value", "quantity",
                                                 "at",      "reference", "bound", "cost"};
  std::string text = line(row);
  text.pop_back();
  return {kColumns, text};
}

double hardness(const Row& row) {
  const auto [error, allowed] = testing::replay(row);
  return error / allowed;
}

/// By profile and quantity, the hardest row that a file has.
class File {
 public:
  explicit File(std::string path) : path_(std::move(path)) {
    if (std::filesystem::exists(path_))
      for (const Row& row : testing::read_rows(path_)) keep(row);
  }

  void add_if_harder(const ReferenceRow& reference) {
    const Row row = as_row(reference);
    const auto known = hardest_.find(key(row));
    if (known == hardest_.end() || hardness(row) > known->second) keep(row);
  }

  void write() const {
    std::ofstream out(path_);
    out << head("slipstick_references search, which never drops a row");
    for (const std::string& line : lines_) out << line << '\n';
    if (!out.flush()) throw std::runtime_error("cannot write " + path_);
  }

 private:
  static std::string key(const Row& row) { return row.text("profile") + ' ' + row.text("quantity"); }
  void keep(const Row& row) {
    lines_.push_back(row.line());
    double& most = hardest_[key(row)];
    most = std::max(most, hardness(row));
  }

  std::string path_;
  std::vector<std::string> lines_;
  std::map<std::string, double> hardest_;
};

/// A sample of the range: uniform, or close to either end by logarithm.
Input draw(const Function& function, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto place = [&] {
    const double x = uniform(generator);
    const double near = std::pow(10.0, -15 * uniform(generator));
    return std::vector{x, near, 1 - near}[generator() % 3];
  };
  Input input{.value = place(), .fraction = place()};
  if (function.given == "twist") input.value = 3 * uniform(generator) * input.value;
  input.value = std::clamp(input.value, 1e-16, 1 - 1e-16);
  input.fraction = std::clamp(input.fraction, 1e-12, 1 - 1e-13);
  return input;
}

/// The same input a little beside.
Input beside(const Input& input, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double step = std::pow(10.0, -2 - 13 * std::abs(uniform(generator))) * uniform(generator);
  return {.value = std::min(input.value * (1 + step), 1 - 1e-16), .fraction = input.fraction};
}

/// The hardest input of a quantity so far.
struct Candidate {
  Input input;
  ReferenceRow row;
  double hardness = 0;
};
using Candidates = std::map<std::string, Candidate>;  ///< by quantity

void consider(const std::string& profile, const Function& function, const Input& input,
              Candidates& candidates) try {
  for (const ReferenceRow& row : rows(profile, function, input)) {
    Candidate& best = candidates[row.quantity];
    const double hard = hardness(as_row(row));
    if (hard > best.hardness) best = {.input = input, .row = row, .hardness = hard};
  }
} catch (const std::domain_error&) {
  // outside the range of the function
}

void search(const std::string& profile, const Function& function, const Search& options, File& file) {
  constexpr int kBeside = 30;  // inputs tried about each of the hardest
  std::mt19937_64 generator(options.seed);
  Candidates candidates;
  for (int i = 0; i < options.samples; ++i)
    consider(profile, function, draw(function, generator), candidates);
  const Candidates sampled = candidates;
  for (const auto& [quantity, candidate] : sampled)
    for (int i = 0; i < kBeside; ++i)
      consider(profile, function, beside(candidate.input, generator), candidates);
  for (const auto& [quantity, candidate] : candidates)
    if (candidate.hardness > 0) file.add_if_harder(candidate.row);
}

}  // namespace

void search_hardest(const Search& options) {
  for (const Function& function : kFunctions) {
    File file(options.folder + '/' + function.file());
    for (const std::string& profile : kProfiles) search(profile, function, options, file);
    file.write();
  }
}

}  // namespace slipstick::analytic::certified
