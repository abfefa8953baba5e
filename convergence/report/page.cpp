#include "convergence/report/page.hpp"

#include <algorithm>

#include "convergence/gates/gate_report.hpp"

namespace slipstick::convergence {
namespace {

template <class Part>
void set(Json& json, const std::string& key, const std::optional<Part>& part) {
  if (part) json.emplace(key, Json(*part));
}

Json to_json(const SceneDescription& scene) {
  const SceneDescription::Gap& gap = scene.gap;
  return {{"name", scene.name},
          {"text", scene.text},
          {"summary", scene.summary},
          {"gap",
           {{"x1", gap.x1},
            {"along_1", gap.along_1},
            {"x2", gap.x2},
            {"along_2", gap.along_2},
            {"map", gap.map}}}};
}

Json to_json(const PageNumber& row) {
  Json json{
      {"key", row.key}, {"words", row.words}, {"unit", row.unit}, {"value", row.value}, {"basis", row.basis}};
  set_number(json, "reference", row.reference);
  set_number(json, "error", row.error);
  set_number(json, "mesh", row.mesh);
  set_number(json, "path", row.path);
  set_number(json, "uncertainty", row.uncertainty);
  return json;
}

Json to_json(const CostPoint& point) {
  Json json{{"method", point.method},
            {"cells", point.cells},
            {"tolerance", point.tolerance},
            {"status", point.status}};
  set_number(json, "seconds", point.seconds);
  set_number(json, "error", point.error);
  return json;
}

Json to_json(const PageProgram& row) {
  Json json{{"name", row.name},       {"cells", row.cells},     {"status", row.status},
            {"version", row.version}, {"message", row.message}, {"number", row.number}};
  set_number(json, "seconds", row.seconds);
  set_number(json, "cpu_seconds", row.cpu_seconds);
  set_number(json, "error", row.error);
  return json;
}

Json to_json(const OperatorTime& row) {
  Json json{{"operator", row.kind}, {"cells", row.cells}};
  set_number(json, "seconds", row.seconds);
  set_number(json, "low", row.low);
  set_number(json, "high", row.high);
  return json;
}

Json to_json(const KnownField& field) {
  Json json{{"program", field.program}, {"file", field.file}, {"expected", field.expected}};
  json.update(field.check);
  return json;
}

template <class Part>
Json list(const std::vector<Part>& parts) {
  Json json = Json::array();
  for (const Part& part : parts) json.push_back(to_json(part));
  return json;
}

Json to_json(const Cost& cost) {
  Json json{{"number", cost.number}, {"points", list(cost.points)}, {"choices", cost.choices}};
  set_number(json, "reference_uncertainty", cost.reference_uncertainty);
  return json;
}

Json to_json(const OperatorTimes& times) {
  Json json{{"rows", list(times.rows)}, {"remark", times.remark}};
  set_number(json, "cells", times.cells);
  set_number(json, "low", times.low);
  set_number(json, "high", times.high);
  return json;
}

Json to_json(const PaperValidation& paper) {
  Json json = paper.figures;
  json.update(
      Json{{"hard", paper.hard}, {"peers", list(paper.peers)}, {"literature", gates_json(paper.literature)}});
  if (paper.gates) json.emplace("gates", gates_json(*paper.gates));
  return json;
}

}  // namespace

std::string Headline::verdict() const {
  constexpr const char* kVerdicts[] = {"good", "open", "bad"};
  Shown worst = Shown::holds;
  for (const Finding& finding : findings) worst = std::max(worst, finding.shown);
  return kVerdicts[static_cast<int>(worst)];
}

Json to_json(const Headline& headline) {
  constexpr const char* kChecks[] = {"holds", "open", "fails"};
  Json lines = Json::array();
  Json counts{{"checks", Json::object()}};
  for (const auto& [what, line, found] : headline.findings) {
    lines.push_back({what, line});
    counts.front().emplace(what, kChecks[static_cast<int>(found)]);
  }
  counts.update(headline.counts);
  Json numbers = Json::object();
  for (const auto& [key, value] : headline.numbers) numbers.emplace(key, value);
  Json json{{"verdict", headline.verdict()},
            {"commit", headline.commit},
            {"lines", lines},
            {"numbers", numbers},
            {"counts", counts},
            {"changes", headline.changes}};
  if (headline.since.empty()) {
    set_missing(json, "since", "the first page in its folder");
  } else {
    json.emplace("since", headline.since);
  }
  return json;
}

Json to_json(const SceneCosts& costs) {
  Json json{{"provenance", costs.provenance},
            {"scene", costs.scene},
            {"numbers", list(costs.numbers)},
            {"cost", to_json(costs.cost)},
            {"operators", to_json(costs.operators)}};
  if (costs.programs) json.emplace("programs", list(*costs.programs));
  return json;
}

Json to_json(const Page& page) {
  Json json{{"provenance", page.provenance}, {"scene", to_json(page.scene)}, {"answer", page.answer}};
  set(json, "check", page.check);
  json.update(Json{{"studies", list(page.studies)}, {"numbers", list(page.numbers)}});
  set(json, "uncertainty", page.uncertainty);
  if (page.cost) json.emplace("cost", to_json(*page.cost));
  if (page.programs) json.emplace("programs", list(*page.programs));
  if (page.operators) json.emplace("operators", to_json(*page.operators));
  set(json, "hard", page.hard);
  set(json, "digits", page.digits);
  if (page.paper) json.emplace("paper", to_json(*page.paper));
  json.emplace("headline", to_json(page.headline));
  return json;
}

}  // namespace slipstick::convergence
