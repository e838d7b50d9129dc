// The Touchstone reader on arbitrary bytes, as files of one, two, three and sixteen ports.
#include "acquisition/touchstone.hpp"

#include "response.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const int ports : {1, 2, 3, 16}) {
    bodeflow::fuzz::read_response_text(data, size,
                                       [&](auto& source) { return bodeflow::acquisition::read_touchstone(source, ports); });
  }
  return 0;
}
