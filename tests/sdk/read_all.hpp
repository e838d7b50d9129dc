#pragma once

#include <bodeflow/record.hpp>
#include <cstdint>

/// A sum over all that a record holds: every byte that a view can lead to is read.
inline std::uint64_t read_all(const bodeflow::RecordView& record) {
  std::uint64_t sum = 0;
  const auto add = [&](std::string_view text) {
    for (const char c : text) sum += static_cast<unsigned char>(c);
  };
  add(record.type());
  for (const bodeflow::AttributeView& a : record.attributes()) {
    add(a.name());
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a.kind() == bodeflow::AttributeKind::text) {
        add(a.text(i));
      } else {
        sum += static_cast<std::uint64_t>(a.integer(i));
      }
    }
    static_cast<void>(record.attribute(a.name()).value());
  }
  for (const bodeflow::ArrayView& a : record.arrays()) {
    add(a.name);
    add(a.unit);
    std::uint64_t elements = 1;
    for (const std::uint64_t n : a.shape) elements *= n;
    const auto* bytes = static_cast<const std::uint8_t*>(a.data);
    for (std::uint64_t i = 0; i < elements * bodeflow::element_size(a.element); ++i) sum += bytes[i];
  }
  return sum;
}
