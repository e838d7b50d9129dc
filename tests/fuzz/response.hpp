#pragma once

#include <bodeflow/error.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "acquisition/response_record.hpp"

namespace bodeflow::fuzz {

/// What must hold of a table that a reader gave back: sizes that fit, finite numbers, rising frequencies; and it becomes a record
/// or is refused with words.
inline void check_response(const acquisition::ResponseTable& table) {
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  const auto& f = table.frequency_hz;
  require(!f.empty() && !table.elements.empty());
  for (std::size_t k = 0; k < f.size(); ++k) require(std::isfinite(f[k]) && f[k] >= 0.0 && (k == 0 || f[k] > f[k - 1]));
  for (const acquisition::ResponseElement& e : table.elements) {
    require(e.value.size() == f.size());
    require(e.variance.empty() || e.variance.size() == f.size());
    for (const auto& value : e.value) require(std::isfinite(value.real()) && std::isfinite(value.imag()));
    for (const double variance : e.variance) require(std::isfinite(variance) && variance >= 0.0);
  }
  const auto response = acquisition::assemble(table, {});
  if (!response) return require(!response.error().text.empty());
  require(!acquisition::summary_of(*response).empty());
  require(acquisition::response_record(*response, {}, "file").size() > 0);
}

template <class Read>
void read_response_text(const std::uint8_t* data, std::size_t size, Read&& read) {
  const auto source = acquisition::open_memory({reinterpret_cast<const char*>(data), size});
  const auto table = read(*source);
  if (table) return check_response(*table);
  if (table.error().text.empty()) std::abort();
}

}  // namespace bodeflow::fuzz
