#include "json_record.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

namespace bodeflow::acquisition {
namespace {

using Json = nlohmann::ordered_json;
using Complex = std::complex<double>;

template <class Test>
bool all_of(const Json& list, Test test) {
  return !list.empty() && std::all_of(list.begin(), list.end(), test);
}

bool is_integer(const Json& x) { return x.is_number_integer(); }

double number_in(const Json& x) {
  if (x.is_null()) return std::nan("");
  if (!x.is_number()) fail(std::string("found ") + x.type_name() + " where a number is needed");
  return x.get<double>();
}

std::int64_t integer_in(const Json& x) {
  if (!x.is_number_integer()) fail(std::string("found ") + x.type_name() + " where an integer is needed");
  if (x.is_number_unsigned() && x.get<std::uint64_t>() > std::uint64_t{INT64_MAX}) fail("an integer is beyond 64 bits");
  return x.get<std::int64_t>();
}

Complex complex_in(const Json& x) {
  if (!x.is_array() || x.size() != 2) fail("a complex number is [re, im]");
  return {number_in(x[0]), number_in(x[1])};
}

template <class T, class Get>
std::vector<T> list_in(const Json& list, Get get) {
  std::vector<T> values;
  values.reserve(list.size());
  for (const Json& x : list) values.push_back(get(x));
  return values;
}

void set_attribute(RecordBuilder& record, const std::string& name, const Json& value) {
  if (value.is_boolean())
    record.set(name, value.get<bool>());
  else if (value.is_string())
    record.set(name, value.get<std::string>());
  else if (is_integer(value))
    record.set(name, integer_in(value));
  else if (!value.is_array())
    record.set(name, number_in(value));
  else if (all_of(value, [](const Json& x) { return x.is_string(); }) || value.empty())
    record.set(name, value.get<std::vector<std::string>>());
  else if (all_of(value, [](const Json& x) { return x.is_boolean(); }))
    record.set(name, value.get<std::vector<bool>>());
  else if (all_of(value, is_integer))
    record.set(name, list_in<std::int64_t>(value, integer_in));
  else
    record.set(name, list_in<double>(value, number_in));
}

/// The elements of an array: as it says, else as its data look.
std::string element_of(const Json& array) {
  if (const auto named = array.find("element"); named != array.end()) return named->is_string() ? named->get<std::string>() : "";
  const Json& data = array["data"];
  if (data.empty()) return element_name(BF_F64);
  if (data.front().is_array()) return element_name(BF_C64);
  return element_name(all_of(data, is_integer) ? BF_I64 : BF_F64);
}

std::vector<std::uint64_t> shape_of(const Json& array) {
  std::vector<std::uint64_t> shape;
  std::uint64_t size = 1;
  for (const Json& n : array["shape"]) {
    const std::int64_t extent = integer_in(n);
    if (extent < 0) fail("its shape has a negative extent");
    shape.push_back(static_cast<std::uint64_t>(extent));
    if (__builtin_mul_overflow(size, shape.back(), &size)) fail("its shape is too large");
  }
  if (size != array["data"].size())
    fail("its shape needs " + std::to_string(size) + " values, 'data' has " + std::to_string(array["data"].size()));
  return shape;
}

void set_array(RecordBuilder& record, const std::string& name, const Json& array) {
  for (const char* key : {"unit", "shape", "data"})
    if (!array.is_object() || !array.contains(key)) fail(std::string("'") + key + "' is missing");
  const Json& data = array["data"];
  if (!array["unit"].is_string()) fail("'unit' is no text");
  if (!data.is_array() || !array["shape"].is_array()) fail("'shape' and 'data' must be lists");
  const auto shape = shape_of(array);
  const auto unit = array["unit"].get<std::string>();
  const auto fill = [&](auto zero, auto get) {
    const auto out = record.array<decltype(zero)>(name, unit, shape);
    std::transform(data.begin(), data.end(), out.begin(), get);
  };
  const std::string element = element_of(array);
  if (element == element_name(BF_F64))
    fill(double{}, number_in);
  else if (element == element_name(BF_C64))
    fill(Complex{}, complex_in);
  else if (element == element_name(BF_I64))
    fill(std::int64_t{}, integer_in);
  else if (element == element_name(BF_U8))
    fill(std::uint8_t{}, [](const Json& x) {
      const std::int64_t byte = integer_in(x);
      if (byte < 0 || byte > 255) fail(std::to_string(byte) + " is no byte");
      return static_cast<std::uint8_t>(byte);
    });
  else
    fail("unknown elements '" + element + "'");
}

/// Calls `set` for each member of an object that may be absent.
template <class Set>
void each(const Json& json, const char* key, const char* what, Set set) {
  const auto members = json.find(key);
  if (members == json.end()) return;
  if (!members->is_object()) fail(std::string("'") + key + "' is no object");
  for (const auto& [name, value] : members->items()) {
    try {
      set(name, value);
    } catch (const std::exception& error) {
      fail(std::string(what) + " '" + name + "': " + error.what());
    }
  }
}

}  // namespace

Expected<RecordBuilder> record_of_json(const Json& json) {
  try {
    if (!json.is_object() || !json.contains("type") || !json["type"].is_string()) fail("is no record: 'type' is missing");
    RecordBuilder record(json["type"].get<std::string>());
    each(json, "attributes", "attribute", [&](const std::string& n, const Json& v) { set_attribute(record, n, v); });
    each(json, "arrays", "array", [&](const std::string& n, const Json& v) { set_array(record, n, v); });
    return record;
  } catch (const std::exception& error) {
    return unexpected(error.what());
  }
}

}  // namespace bodeflow::acquisition
