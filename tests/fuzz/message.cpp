// The decoders of messages and credits on arbitrary bytes: what they accept stays inside the bytes and survives being written
// again.
#include <cstdint>
#include <cstdlib>

#include "transport/credit.hpp"
#include "transport/wire.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bodeflow::transport;
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  if (const auto message = decode(bytes)) {
    const auto* begin = message->payload.data();
    if (begin < bytes.data() || begin + message->payload.size() > bytes.data() + size) std::abort();
    if (!refusal(message->header, message->payload.size()).empty()) std::abort();
    const std::span<const std::byte> parts[] = {message->payload};
    const auto again = encode(message->header, parts);
    const auto twice = decode(again);
    if (!twice || twice->header.sequence != message->header.sequence || twice->payload.size() != message->payload.size())
      std::abort();
  }
  if (const auto credit = decode_credit(bytes)) {
    if (decode_credit(encode(*credit))->taken != credit->taken) std::abort();
  }
  return 0;
}
