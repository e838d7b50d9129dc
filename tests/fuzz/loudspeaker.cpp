// The readers of .frd and .zma files on arbitrary bytes.
#include "acquisition/response_columns.hpp"
#include "response.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bodeflow::acquisition;
  for (const auto kind : {LoudspeakerFile::frd, LoudspeakerFile::zma}) {
    bodeflow::fuzz::read_response_text(data, size, [&](auto& source) { return read_loudspeaker_file(source, kind); });
  }
  return 0;
}
