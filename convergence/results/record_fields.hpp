#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "convergence/results/solve_record.hpp"
#include "solver/input/input_error.hpp"

/// Writes and reads the keys of records: list_fields(fields, record) names the keys of a struct in their
/// order, and FieldWriter and FieldReader carry it out in the two directions.
namespace slipstick::convergence {

template <typename T, typename Record>
concept Is = std::same_as<std::remove_const_t<T>, Record>;

inline std::string reason_key(const char* key) { return std::string(key) + "_reason"; }

inline constexpr std::array kStatusWords{"converged", "not_converged", "refused", "failed"};

class FieldWriter {
 public:
  explicit FieldWriter(Json& object) : object_(object) {}

  void operator()(const char* key, const Number& number) {
    put_or_reason(key, std::isfinite(number.value), number.value, number.why_missing);
  }
  void operator()(const char* key, const Components& pair) {
    put_or_reason(key, pair.is_known(), pair.values, pair.why_missing);
  }
  void operator()(const char* key, const RunStatus& status) { object_[key] = to_string(status); }
  template <typename T>
  void operator()(const char* key, const std::optional<T>& value) {
    if (value) (*this)(key, *value);
  }
  template <typename T>
  void operator()(const char* key, const T& value) {
    object_[key] = json_of(value);
  }
  /// A text or list that is left out where it is empty.
  template <typename T>
  void unless_empty(const char* key, const T& value) {
    if (!value.empty()) (*this)(key, value);
  }
  void if_true(const char* key, bool value) {
    if (value) object_[key] = value;
  }
  /// The keys that follow depend on this one: a reader reads it, or whether it is there, ahead of its turn.
  template <typename T>
  void ahead(const char*, const T&) {}

  template <typename List>
  void within(const char* key, const List& list_inner) {
    FieldWriter inner(object_[key]);
    list_inner(inner);
  }
  /// Keys that this kind of result does not have.
  void missing(std::initializer_list<const char*> keys, const std::string& reason) {
    for (const char* key : keys) (*this)(key, Number{.why_missing = reason});
  }

  template <typename T>
  static Json json_of(const T& value) {
    if constexpr (requires(FieldWriter & fields) { list_fields(fields, value); }) {
      Json object = Json::object();
      FieldWriter fields(object);
      list_fields(fields, value);
      return object;
    } else {
      return value;
    }
  }
  template <typename T>
  static Json json_of(const std::vector<T>& values) {
    Json list = Json::array();
    for (const T& value : values) list.push_back(json_of(value));
    return list;
  }

 private:
  template <typename T>
  void put_or_reason(const char* key, bool is_known, const T& value, const std::string& reason) {
    object_[key] = is_known ? Json(value) : Json();
    if (!is_known && !reason.empty()) object_[reason_key(key)] = reason;
  }

  Json& object_;
};

class FieldReader {
 public:
  explicit FieldReader(const Json& object) : object_(object) {}

  void operator()(const char* key, Number& number) { get_or_reason(key, number.value, number.why_missing); }
  void operator()(const char* key, Components& pair) { get_or_reason(key, pair.values, pair.why_missing); }
  void operator()(const char* key, RunStatus& status) {
    const auto found = std::ranges::find(kStatusWords, object_.at(key).get<std::string>());
    if (found == kStatusWords.end()) throw solver::InputError("a result", "has no such status");
    status = static_cast<RunStatus>(found - kStatusWords.begin());
  }
  template <typename T>
  void operator()(const char* key, std::optional<T>& value) {
    if (object_.contains(key)) (*this)(key, value.emplace());
  }
  template <typename T>
  void operator()(const char* key, T& value) {
    read(object_.at(key), value);
  }
  template <typename T>
  void unless_empty(const char* key, T& value) {
    if (object_.contains(key)) (*this)(key, value);
  }
  void if_true(const char* key, bool& value) { value = object_.value(key, false); }
  template <typename T>
  void ahead(const char* key, std::optional<T>& value) {
    if (object_.contains(key)) value.emplace();
  }
  void ahead(const char* key, RunStatus& status) { (*this)(key, status); }
  template <typename List>
  void within(const char* key, const List& list_inner) {
    FieldReader inner(object_.at(key));
    list_inner(inner);
  }
  void missing(std::initializer_list<const char*>, const std::string&) {}

 private:
  template <typename T>
  static void read(const Json& json, T& value) {
    if constexpr (requires(FieldReader & fields) { list_fields(fields, value); }) {
      FieldReader fields(json);
      list_fields(fields, value);
    } else if constexpr (std::floating_point<T>) {  // JSON has null for NaN and infinity
      value = json.is_null() ? Number().value : json.get<T>();
    } else {
      value = json.get<T>();
    }
  }
  template <typename T>
  static void read(const Json& json, std::vector<T>& values) {
    for (const Json& each : json) read(each, values.emplace_back());
  }
  template <typename T>
  void get_or_reason(const char* key, T& value, std::string& reason) {
    const Json& found = object_.at(key);
    if (found.is_null()) {
      reason = object_.value(reason_key(key), "");
    } else {
      value = found.get<T>();
    }
  }

  const Json& object_;
};

}  // namespace slipstick::convergence
