// The reader of universal files (data sets 58 and 58b) on arbitrary bytes.
#include <string_view>

#include "acquisition/uff_table.hpp"
#include "table.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto open = [text] { return Expected<std::unique_ptr<ByteSource>>(open_memory(text)); };
  fuzz::read_all_ways([&] { return open_uff(open, "fuzz.uff"); });
  return 0;
}
