// The reader of frequency response functions in universal files on arbitrary bytes.
#include "acquisition/uff_response.hpp"

#include "response.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bodeflow::fuzz::read_response_text(data, size, [](auto& source) { return bodeflow::acquisition::read_uff_response(source); });
  return 0;
}
