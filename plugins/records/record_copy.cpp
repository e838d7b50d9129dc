#include "record_copy.hpp"

#include <algorithm>
#include <complex>

namespace bodeflow::records {
namespace {

template <class Get>
void set_as(RecordBuilder& r, const AttributeView& a, Get get) {
  using Value = decltype(get(a, 0));
  if (!a.is_list()) {
    r.set(a.name(), get(a, 0));
    return;
  }
  std::vector<Value> values;
  for (std::size_t i = 0; i < a.size(); ++i) values.push_back(get(a, i));
  r.set(a.name(), values);
}

template <class T>
void add(RecordBuilder& r, const ArrayView& a) {
  const auto from = a.as<T>();
  const std::vector<std::uint64_t> shape(a.shape.begin(), a.shape.end());
  std::copy(from.begin(), from.end(), r.array<T>(a.name, a.unit, std::span<const std::uint64_t>(shape)).begin());
}

}  // namespace

RecordBuilder copy_of(const RecordView& record) {
  RecordBuilder r(record.type());
  for (const AttributeView a : record.attributes()) {
    switch (a.kind()) {
      case AttributeKind::boolean:
        set_as(r, a, [](const AttributeView& v, std::size_t i) { return v.boolean(i); });
        break;
      case AttributeKind::integer:
        set_as(r, a, [](const AttributeView& v, std::size_t i) { return v.integer(i); });
        break;
      case AttributeKind::number:
        set_as(r, a, [](const AttributeView& v, std::size_t i) { return v.number(i); });
        break;
      case AttributeKind::text:
        set_as(r, a, [](const AttributeView& v, std::size_t i) { return std::string(v.text(i)); });
        break;
    }
  }
  for (const ArrayView a : record.arrays()) {
    if (a.element == BF_F64) add<double>(r, a);
    if (a.element == BF_C64) add<std::complex<double>>(r, a);
    if (a.element == BF_I64) add<std::int64_t>(r, a);
    if (a.element == BF_U8) add<std::uint8_t>(r, a);
  }
  return r;
}

}  // namespace bodeflow::records
