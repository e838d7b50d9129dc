#include "report/record.hpp"

#include <algorithm>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

ordered_json value_of(const AttributeView& attribute, std::size_t i) {
  switch (attribute.kind()) {
    case AttributeKind::boolean:
      return attribute.boolean(i);
    case AttributeKind::integer:
      return attribute.integer(i);
    case AttributeKind::number:
      return attribute.number(i);
    default:
      return std::string(attribute.text(i));
  }
}

Array array_of(const ArrayView& view) {
  Array array{std::string(view.unit), {view.shape.begin(), view.shape.end()}, {}, {}};
  switch (view.element) {
    case BF_C64:
      for (const auto& z : view.as<std::complex<double>>()) {
        array.re.push_back(z.real());
        array.im.push_back(z.imag());
      }
      break;
    case BF_I64:
      for (const std::int64_t x : view.as<std::int64_t>()) array.re.push_back(static_cast<double>(x));
      break;
    case BF_F64:
      for (const double x : view.as<double>()) array.re.push_back(x);
      break;
    default:
      for (const std::uint8_t x : view.as<std::uint8_t>()) array.re.push_back(x);
      break;
  }
  return array;
}

}  // namespace

const Array* Record::array(const std::string& name) const {
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const auto& entry) { return entry.first == name; });
  return found == arrays.end() ? nullptr : &found->second;
}

const Array* Record::array(const std::string& name, const std::vector<std::uint64_t>& shape, bool complex) const {
  const Array* found = array(name);
  const bool fits = found != nullptr && found->shape == shape && (complex || !found->is_complex());
  return fits ? found : nullptr;
}

std::string Record::text(const std::string& name) const {
  const auto found = attributes.find(name);
  return found != attributes.end() && found->is_string() ? found->get<std::string>() : "";
}

double Record::number(const std::string& name) const {
  const auto found = attributes.find(name);
  return found != attributes.end() && found->is_number() ? found->get<double>() : kNaN;
}

std::vector<std::string> Record::texts(const std::string& name) const {
  std::vector<std::string> all;
  const auto found = attributes.find(name);
  if (found == attributes.end()) return all;
  if (found->is_string() && !found->get_ref<const std::string&>().empty()) all.push_back(found->get<std::string>());
  if (found->is_array())
    for (const auto& item : *found)
      if (item.is_string()) all.push_back(item.get<std::string>());
  return all;
}

std::string Record::text_at(const std::string& name, std::size_t i, const std::string& otherwise) const {
  const auto all = texts(name);
  return i < all.size() && !all[i].empty() ? all[i] : otherwise;
}

std::uint64_t count_of(const std::vector<std::uint64_t>& shape) {
  std::uint64_t count = 1;
  for (const std::uint64_t size : shape) {
    if (size != 0 && count > UINT64_MAX / size) return UINT64_MAX;
    count *= size;
  }
  return count;
}

Record record_of(const std::string& key, const RecordView& view) {
  Record record;
  record.key = key;
  record.type = std::string(view.type());
  for (const auto& attribute : view.attributes()) {
    ordered_json& value = record.attributes[std::string(attribute.name())];
    if (!attribute.is_list()) {
      value = value_of(attribute, 0);
      continue;
    }
    value = ordered_json::array();
    for (std::size_t i = 0; i < attribute.size(); ++i) value.push_back(value_of(attribute, i));
  }
  for (const auto& array : view.arrays()) record.arrays.emplace_back(std::string(array.name), array_of(array));
  return record;
}

}  // namespace bodeflow::tools::report
