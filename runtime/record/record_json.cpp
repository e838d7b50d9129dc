#include <algorithm>
#include <bodeflow/record.hpp>
#include <cmath>
#include <complex>
#include <limits>

#include "record/run_directory.hpp"

namespace bodeflow::record {
namespace {

using nlohmann::ordered_json;

ordered_json number_json(double x) { return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr); }

ordered_json attribute_value(const AttributeView& attribute, std::size_t i) {
  switch (attribute.kind()) {
    case AttributeKind::boolean:
      return attribute.boolean(i);
    case AttributeKind::integer:
      return attribute.integer(i);
    case AttributeKind::number:
      return number_json(attribute.number(i));
    case AttributeKind::text:
      return std::string(attribute.text(i));
  }
  return nullptr;
}

ordered_json attribute_json(const AttributeView& attribute) {
  if (!attribute.is_list()) return attribute_value(attribute, 0);
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < attribute.size(); ++i) list.push_back(attribute_value(attribute, i));
  return list;
}

ordered_json data_json(const ArrayView& array) {
  ordered_json data = ordered_json::array();
  switch (array.element) {
    case BF_F64:
      for (const double x : array.as<double>()) data.push_back(number_json(x));
      break;
    case BF_C64:
      for (const auto& z : array.as<std::complex<double>>()) data.push_back({number_json(z.real()), number_json(z.imag())});
      break;
    case BF_I64:
      for (const std::int64_t x : array.as<std::int64_t>()) data.push_back(x);
      break;
    default:
      for (const std::uint8_t x : array.as<std::uint8_t>()) data.push_back(x);
      break;
  }
  return data;
}

/// What the data alone tells of the element type.
std::uint32_t element_of_data(const ordered_json& data) {
  if (data.empty()) return BF_F64;
  if (data.front().is_array()) return BF_C64;
  const bool integers = std::all_of(data.begin(), data.end(), [](const auto& x) { return x.is_number_integer(); });
  return integers ? BF_I64 : BF_F64;
}

double number_from(const ordered_json& json, const std::string& where) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!json.is_number()) fail(where + ": found " + json.type_name() + " where a number is needed");
  return json.get<double>();
}

std::int64_t integer_from(const ordered_json& json, const std::string& where) {
  if (!json.is_number_integer()) fail(where + ": found " + json.type_name() + " where an integer is needed");
  if (json.is_number_unsigned() &&
      json.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    fail(where + ": an integer is beyond 64 bits");
  return json.get<std::int64_t>();
}

void set_list(RecordBuilder& record, const std::string& name, const ordered_json& list) {
  const auto all = [&](auto test) { return !list.empty() && std::all_of(list.begin(), list.end(), test); };
  const std::string where = "attribute '" + name + "'";
  if (all([](const auto& x) { return x.is_string(); })) {
    record.set(name, list.get<std::vector<std::string>>());
  } else if (all([](const auto& x) { return x.is_boolean(); })) {
    record.set(name, list.get<std::vector<bool>>());
  } else if (all([](const auto& x) { return x.is_number_integer(); })) {
    std::vector<std::int64_t> integers;
    for (const auto& x : list) integers.push_back(integer_from(x, where));
    record.set(name, integers);
  } else {
    std::vector<double> numbers;
    for (const auto& x : list) numbers.push_back(number_from(x, where));
    record.set(name, numbers);
  }
}

void set_attribute(RecordBuilder& record, const std::string& name, const ordered_json& value) {
  const std::string where = "attribute '" + name + "'";
  if (value.is_array())
    set_list(record, name, value);
  else if (value.is_boolean())
    record.set(name, value.get<bool>());
  else if (value.is_number_integer())
    record.set(name, integer_from(value, where));
  else if (value.is_string())
    record.set(name, value.get<std::string>());
  else
    record.set(name, number_from(value, where));
}

std::uint32_t element_from(const ordered_json& array, const ordered_json& data, const std::string& where) {
  const auto named = array.find("element");
  if (named == array.end()) return element_of_data(data);
  for (const std::uint32_t element : {BF_F64, BF_C64, BF_I64, BF_U8})
    if (*named == element_name(element)) return element;
  fail(where + ": unknown element type " + named->dump());
}

template <class T, class Get>
void fill(RecordBuilder& record, const std::string& name, const std::string& unit, std::span<const std::uint64_t> shape,
          const ordered_json& data, Get get) {
  const auto out = record.array<T>(name, unit, shape);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = get(data[i]);
}

void set_array(RecordBuilder& record, const std::string& name, const ordered_json& array) {
  const std::string where = "array '" + name + "'";
  for (const char* key : {"unit", "shape", "data"})
    if (!array.is_object() || !array.contains(key)) fail(where + ": '" + key + "' is missing");
  const ordered_json& data = array["data"];
  if (!data.is_array() || !array["shape"].is_array()) fail(where + ": 'shape' and 'data' must be lists");
  std::vector<std::uint64_t> shape;
  std::uint64_t size = 1;
  for (const auto& n : array["shape"]) {
    const std::int64_t extent = integer_from(n, where);
    if (extent < 0) fail(where + ": its shape has a negative extent");
    shape.push_back(static_cast<std::uint64_t>(extent));
    if (__builtin_mul_overflow(size, shape.back(), &size)) fail(where + ": its shape is too large");
  }
  if (size != data.size())
    fail(where + ": its shape needs " + std::to_string(size) + " values, 'data' has " + std::to_string(data.size()));

  const auto unit = array["unit"].get<std::string>();
  const auto number = [&](const ordered_json& x) { return number_from(x, where); };
  switch (element_from(array, data, where)) {
    case BF_C64:
      return fill<std::complex<double>>(record, name, unit, shape, data, [&](const ordered_json& z) {
        if (!z.is_array() || z.size() != 2) fail(where + ": a complex value is [re, im]");
        return std::complex<double>(number(z[0]), number(z[1]));
      });
    case BF_I64:
      return fill<std::int64_t>(record, name, unit, shape, data, [&](const ordered_json& x) { return integer_from(x, where); });
    case BF_U8:
      return fill<std::uint8_t>(record, name, unit, shape, data, [&](const ordered_json& x) {
        const std::int64_t byte = integer_from(x, where);
        if (byte < 0 || byte > 255) fail(where + ": " + std::to_string(byte) + " is not a byte");
        return static_cast<std::uint8_t>(byte);
      });
    default:
      return fill<double>(record, name, unit, shape, data, number);
  }
}

SharedRecord parse(const ordered_json& json) {
  if (!json.is_object() || !json.contains("type") || !json["type"].is_string()) fail("'type' is missing");
  RecordBuilder record(json["type"].get<std::string>());
  if (const auto attributes = json.find("attributes"); attributes != json.end())
    for (const auto& [name, value] : attributes->items()) set_attribute(record, name, value);
  if (const auto arrays = json.find("arrays"); arrays != json.end())
    for (const auto& [name, value] : arrays->items()) set_array(record, name, value);
  const std::vector<std::uint8_t> bytes = record.bytes();
  return SharedRecord::copy(bytes.data(), bytes.size());
}

}  // namespace

ordered_json to_json(const SharedRecord& record) {
  const RecordView view(record.bytes());
  ordered_json json;
  json["type"] = std::string(view.type());
  ordered_json& attributes = json["attributes"] = ordered_json::object();
  for (const auto& attribute : view.attributes()) attributes[std::string(attribute.name())] = attribute_json(attribute);
  ordered_json& arrays = json["arrays"] = ordered_json::object();
  for (const auto& array : view.arrays()) {
    ordered_json& entry = arrays[std::string(array.name)];
    entry["unit"] = std::string(array.unit);
    entry["shape"] = std::vector<std::uint64_t>(array.shape.begin(), array.shape.end());
    ordered_json data = data_json(array);
    if (element_of_data(data) != array.element) entry["element"] = element_name(array.element);
    entry["data"] = std::move(data);
  }
  return json;
}

tl::expected<SharedRecord, std::string> record_from_json(const ordered_json& json) {
  try {
    return parse(json);
  } catch (const std::exception& error) {
    return tl::unexpected(std::string("not a record: ") + error.what());
  }
}

}  // namespace bodeflow::record
