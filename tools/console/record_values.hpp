#pragma once

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bodeflow::tools {

// What screens read of records of result.json: they may come from anybody's block, so nothing is taken for granted.

using Json = nlohmann::ordered_json;

inline double number(const Json& value) { return value.is_number() ? value.get<double>() : std::nan(""); }

/// The attribute, or null.
inline const Json& attribute(const Json& record, const char* name) {
  static const Json none;
  const Json& attributes = record["attributes"];
  const auto found = attributes.find(name);
  return found == attributes.end() ? none : *found;
}

inline std::string text(const Json& value, const std::string& otherwise = "") {
  return value.is_string() ? value.get<std::string>() : otherwise;
}

/// Entry i of a list of texts.
inline std::string text_at(const Json& list, std::size_t i, const std::string& otherwise = "") {
  return list.is_array() && i < list.size() ? text(list[i], otherwise) : otherwise;
}

/// A real array with its shape; empty where the record has none of that name.
struct Values {
  std::vector<std::size_t> shape;
  std::vector<double> data;
  std::string unit;

  bool empty() const { return data.empty(); }
  double at(std::size_t i) const { return i < data.size() ? data[i] : std::nan(""); }
  double at(std::size_t row, std::size_t column) const {
    return shape.size() == 2 && column < shape[1] ? at(row * shape[1] + column) : std::nan("");
  }
};

inline Values values(const Json& record, const char* name) {
  Values v;
  const auto found = record["arrays"].find(name);
  if (found == record["arrays"].end()) return v;
  v.shape = (*found)["shape"].get<std::vector<std::size_t>>();
  v.unit = found->value("unit", std::string());
  for (const Json& x : (*found)["data"]) v.data.push_back(number(x));
  return v;
}

/// The entries of a complex array.
inline std::vector<std::complex<double>> complex_values(const Json& record, const char* name) {
  std::vector<std::complex<double>> list;
  const auto found = record["arrays"].find(name);
  if (found == record["arrays"].end()) return list;
  for (const Json& z : (*found)["data"])
    if (z.is_array() && z.size() == 2) list.emplace_back(number(z[0]), number(z[1]));
  return list;
}

}  // namespace bodeflow::tools
