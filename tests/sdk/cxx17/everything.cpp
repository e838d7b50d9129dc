// Every header of the SDK in one plugin, compiled by other compilers and in other modes than the project's own.
#include <bodeflow/block.hpp>
#include <bodeflow/error.hpp>
#include <bodeflow/number.hpp>
#include <bodeflow/parts.hpp>
#include <bodeflow/rate.hpp>
#include <bodeflow/record.hpp>
#include <bodeflow/units.hpp>
#include <bodeflow/utf8.hpp>

#include "../fixtures/good.cpp"

/// Keeps the functions of the record and unit headers from being left out.
bool uses_everything(const std::uint8_t* bytes, std::size_t size) {
  const auto record = bodeflow::RecordView::check({bytes, size});
  return record && record->numbers("x") && record->texts("y") && bodeflow::convert("1 kHz", "Hz").has_value();
}
