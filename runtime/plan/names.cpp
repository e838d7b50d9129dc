#include "plan/names.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace bodeflow::plan {
namespace {

std::string port(const graph::Phase& phase, const graph::End& end, std::uint32_t kind, std::uint32_t direction) {
  const graph::Block& block = phase.blocks[end.block];
  if (end.port == graph::kParameterPort) return block.name + ".parameters";
  return block.name + "." + block.type->port_at(kind, direction, end.port).name;
}

struct Prefix {
  double factor;
  const char* text;
};

template <std::size_t N>
std::string scaled(double value, const std::array<Prefix, N>& prefixes, const char* unit, int digits) {
  const double size = std::abs(value);
  for (const Prefix& prefix : prefixes) {
    if (size >= prefix.factor) return fmt::format("{:.{}g} {}{}", value / prefix.factor, digits, prefix.text, unit);
  }
  return fmt::format("{:.{}g} {}", value, digits, unit);
}

}  // namespace

std::string stream_output(const graph::Phase& phase, const graph::End& end) { return port(phase, end, BF_STREAM, BF_OUT); }
std::string stream_input(const graph::Phase& phase, const graph::End& end) { return port(phase, end, BF_STREAM, BF_IN); }
std::string message_output(const graph::Phase& phase, const graph::End& end) { return port(phase, end, BF_MESSAGE, BF_OUT); }
std::string message_input(const graph::Phase& phase, const graph::End& end) { return port(phase, end, BF_MESSAGE, BF_IN); }

std::string connection(const graph::Phase& phase, const graph::StreamEdge& edge) {
  return stream_output(phase, edge.from) + " -> " + stream_input(phase, edge.to);
}

std::string connection(const graph::Phase& phase, const graph::MessageEdge& edge) {
  return message_output(phase, edge.from) + " -> " + message_input(phase, edge.to);
}

std::string rate_text(const Rate& rate) {
  static constexpr std::array<Prefix, 3> kPrefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}}};
  return scaled(rate.hz(), kPrefixes, "Hz", 10);
}

std::string seconds_text(double seconds) {
  static constexpr std::array<Prefix, 4> kPrefixes{{{1.0, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}}};
  return scaled(seconds, kPrefixes, "s", 6);
}

std::string bytes_text(std::uint64_t bytes) {
  static constexpr std::array<Prefix, 3> kPrefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}}};
  return scaled(static_cast<double>(bytes), kPrefixes, "B", 4);
}

std::string count_text(std::int64_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string element_text(std::uint32_t element) { return element == BF_C64 ? "c64" : element == BF_F64 ? "f64" : "any"; }

}  // namespace bodeflow::plan
