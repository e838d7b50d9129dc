// The CSV reader on arbitrary bytes: no crash, no endless loop, and both passes see the same rows.
#include "acquisition/csv.hpp"

#include <string_view>

#include "table.hpp"

using namespace bodeflow::acquisition;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  bodeflow::fuzz::read_all_ways([&] { return open_csv(open_memory(text), "fuzz.csv"); });
  return 0;
}
