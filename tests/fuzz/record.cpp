// The record decoder on arbitrary bytes: what it accepts can be read whole without leaving the bytes.
#include <cstdint>

#include "../sdk/aligned_bytes.hpp"
#include "../sdk/read_all.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const AlignedBytes bytes(data, size);
  if (const auto record = bodeflow::RecordView::check(bytes.span())) {
    volatile std::uint64_t sum = read_all(*record);
    static_cast<void>(sum);
  }
  return 0;
}
