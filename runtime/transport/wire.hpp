#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::transport {

/// What a message carries.
enum class Kind : std::uint8_t {
  samples = 1,  ///< planar, channel after channel
  record = 2,   ///< the bytes of a record
  horizon = 3,  ///< no payload: nothing more will come that is earlier than the header's time
  end = 4,      ///< no payload: the stream has `position` samples, or no more records come
  text = 5      ///< UTF-8
};

/// The head of every message: the struct `Header` of bodeflow.idl.
///
/// Samples: position of the first one, at `rate_num / rate_den` samples a second. Records and horizons: a time of the run's clock
/// as the exact fraction `position / rate_num` (rate_den = 1).
struct Header {
  Kind kind = Kind::text;
  std::uint64_t stream = 0;
  std::uint32_t epoch = 0;
  std::uint64_t sequence = 0;  ///< messages of this stream and epoch before it
  std::int64_t position = 0;
  std::uint64_t count = 0;  ///< samples a channel
  std::int64_t rate_num = 0, rate_den = 1;
  std::uint32_t channels = 0;
  std::uint32_t element = 0;   ///< BF_F64, BF_C64
  std::int64_t source_ns = 0;  ///< CLOCK_REALTIME of the writer
  std::string clock;           ///< clock domain; "" is the run's own
};

/// A stream id made of a name; never 0.
std::uint64_t stream_id(const std::string& name);

/// The most that one message may carry.
inline constexpr std::uint64_t kMostPayload = std::uint64_t{64} << 20;

/// The CDR bytes (little-endian, with encapsulation) of a message whose payload is `parts` one after the other.
std::vector<std::byte> encode(const Header& header, std::span<const std::span<const std::byte>> parts);

/// The bytes of `encode` that come before the payload.
std::vector<std::byte> encode_head(const Header& header, std::uint64_t payload_bytes);

/// Why a reader would refuse such a message; empty: it would not.
std::string refusal(const Header& header, std::uint64_t payload_bytes);

struct Decoded {
  Header header;
  std::span<const std::byte> payload;  ///< into the bytes
};

/// Checks every length and value before it is used; error: what is wrong, in one sentence. Allocates nothing but the clock's
/// name.
tl::expected<Decoded, std::string> decode(std::span<const std::byte> bytes);

}  // namespace bodeflow::transport
