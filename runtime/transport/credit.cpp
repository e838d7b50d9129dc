#include "transport/credit.hpp"

#include "transport/cdr.hpp"

namespace bodeflow::transport {
namespace {

constexpr std::uint32_t kMagic = 0x52434642;
constexpr std::uint16_t kVersion = 1;
constexpr std::uint16_t kNear = 1;

}  // namespace

std::vector<std::byte> encode(const Credit& credit) {
  cdr::Writer writer;
  writer.put(kMagic);
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(credit.near ? kNear : 0));
  writer.put(credit.stream);
  writer.put(credit.inlet);
  writer.put(credit.epoch);
  for (const auto octet : credit.reader) writer.put(octet);
  writer.put(std::uint32_t{0});
  writer.put(credit.taken);
  return std::move(writer).bytes();
}

tl::expected<Credit, std::string> decode_credit(std::span<const std::byte> bytes) {
  cdr::Reader reader(bytes);
  std::uint32_t magic = 0, reserved = 0;
  std::uint16_t version = 0, flags = 0;
  if (!reader.plain() || !reader.get(magic) || magic != kMagic) return tl::unexpected<std::string>("not a credit of bodeflow");
  if (!reader.get(version) || version != kVersion) return tl::unexpected<std::string>("a credit of an unknown version");
  Credit credit;
  bool whole = reader.get(flags) && reader.get(credit.stream) && reader.get(credit.inlet) && reader.get(credit.epoch);
  for (auto& octet : credit.reader) whole = whole && reader.get(octet);
  whole = whole && reader.get(reserved) && reader.get(credit.taken);
  if (!whole) return tl::unexpected<std::string>("a credit that is cut short");
  credit.near = (flags & kNear) != 0;
  return credit;
}

}  // namespace bodeflow::transport
