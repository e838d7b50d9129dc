#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::transport {

/// How far an inlet has taken a stream: the struct `Credit` of bodeflow.idl.
struct Credit {
  std::uint64_t stream = 0;
  std::uint64_t inlet = 0;
  std::uint32_t epoch = 0;
  std::array<std::uint8_t, 16> reader{};  ///< GUID of its data reader
  bool near = false;                      ///< it reads in shared memory too
  std::uint64_t taken = 0;
};

std::vector<std::byte> encode(const Credit& credit);
tl::expected<Credit, std::string> decode_credit(std::span<const std::byte> bytes);

}  // namespace bodeflow::transport
