// SPDX-License-Identifier: MIT
// A configuration struct as a flat list of typed fields. Each struct has one
//   template <class V> void Visit(V& visit, T& config)
// that names its fields with their range or choices; the list made from it feeds the reader, the
// dump, the hash and the manual. Keys are dotted paths: "policy.poi.use_history".
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace crossnav {

/// One field of a configuration; points into the visited struct, which must outlive it.
struct ConfigField {
  std::string key;
  std::variant<bool*, int*, std::uint64_t*, double*, std::string*> value;
  double lo = 0, hi = 0;             ///< inclusive range of numbers
  std::vector<std::string> choices;  ///< of strings; empty = any
};

/// The visitor that Visit(visit, config) functions are called with.
class ConfigFieldCollector {
 public:
  template <class T>
  void Section(std::string_view name, T& section) {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    Visit(*this, section);
    prefix_ = outer;
  }
  void operator()(std::string_view name, bool& field) { Add(name, &field); }
  void operator()(std::string_view name, std::string& field,
                  std::initializer_list<const char*> choices = {}) {
    Add(name, &field);
    for (const char* choice : choices) fields_.back().choices.emplace_back(choice);
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(std::string_view name, T& field, std::type_identity_t<T> lo,
                  std::type_identity_t<T> hi) {
    Add(name, &field);
    fields_.back().lo = static_cast<double>(lo);
    fields_.back().hi = static_cast<double>(hi);
  }

  std::vector<ConfigField> Take() { return std::move(fields_); }

 private:
  template <class T>
  void Add(std::string_view name, T* field) {
    fields_.push_back({prefix_ + std::string(name), field, 0, 0, {}});
  }
  std::string prefix_;
  std::vector<ConfigField> fields_;
};

/// All fields of `config` in declaration order.
template <class T>
std::vector<ConfigField> FieldsOf(T& config) {
  ConfigFieldCollector collector;
  Visit(collector, config);
  return collector.Take();
}

}  // namespace crossnav
