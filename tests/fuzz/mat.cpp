// The reader of MATLAB v5 files on arbitrary bytes.
#include <string_view>

#include "acquisition/mat_table.hpp"
#include "table.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto open = [bytes] { return Expected<std::unique_ptr<ByteSource>>(open_memory(bytes)); };
  fuzz::read_all_ways([&] { return open_mat(open, "fuzz.mat"); });
  return 0;
}
