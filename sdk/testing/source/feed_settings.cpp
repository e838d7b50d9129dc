#include "feed_settings.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>
#include <sstream>

#include "isolate.hpp"

namespace bodeflow::testing {
namespace {

double quantity(const std::string& text, const char* unit) {
  const auto value = convert(text, unit);
  if (!value) fail(value.error().text);
  return *value;
}

std::uint32_t channels(const std::string& text) {
  return static_cast<std::uint32_t>(std::clamp(quantity(text, "1"), 1.0, 1024.0));
}

std::uint64_t count(const std::string& text) { return static_cast<std::uint64_t>(std::clamp(quantity(text, "1"), 1.0, 1e7)); }

/// The numbers of "[1, 2]".
std::vector<double> numbers(const std::string& name, const std::string& text) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') fail(name + ": '" + text + "' has not the form [1, 2]");
  std::istringstream parts(text.substr(1, text.size() - 2));
  std::vector<double> list;
  for (std::string part; std::getline(parts, part, ',');) list.push_back(quantity(part, "1"));
  return list;
}

void require_input(const bf_block_descriptor& block, const std::string& name, const std::string& port, std::uint32_t flags = 0) {
  const bool found = std::any_of(block.ports, block.ports + block.port_count, [&](const bf_port_descriptor* p) {
    return p->kind == BF_STREAM && p->direction == BF_IN && port == p->name && (p->flags & flags) == flags;
  });
  if (!found) fail(name + ": the block has no " + (flags != 0 ? "optional " : "") + "stream input '" + port + "'");
}

/// Whether `name` is `prefix` and more, which is left in `rest`.
bool begins(const std::string& name, const std::string& prefix, std::string& rest) {
  if (name.compare(0, prefix.size(), prefix) != 0) return false;
  rest = name.substr(prefix.size());
  return true;
}

}  // namespace

void set_feed(Feed& feed, const bf_block_descriptor& block, const std::string& name, const std::string& value) {
  std::string rest;
  if (name == "@rate") {
    feed.rate = Rate::from_hz(quantity(value, "Hz"));
    if (!feed.rate.known()) fail("@rate: '" + value + "' is not a rate");
  } else if (name == "@channels") {
    feed.channels = channels(value);
  } else if (begins(name, "@channels.", rest)) {
    require_input(block, name, rest);
    feed.channels_of[rest] = channels(value);
  } else if (begins(name, "@note.", rest) && rest.find('.') != std::string::npos) {
    const std::string port = rest.substr(0, rest.find('.'));
    require_input(block, name, port);
    feed.notes[port][rest.substr(port.size() + 1)] = numbers(name, value);
  } else if (name == "@unconnected") {
    require_input(block, name, value, BF_PORT_OPTIONAL);
    feed.unconnected.insert(value);
  } else if (name == "@period") {
    feed.period = count(value);
  } else if (name == "@firings") {
    feed.firings = count(value);
  } else if (name == "@element" && (value == "f64" || value == "c64")) {
    feed.element = value == "f64" ? BF_F64 : BF_C64;
  } else {
    fail("'" + name + " = " + value + "' is unknown; known: @rate, @channels, @channels.PORT, @note.PORT.NAME, " +
         "@unconnected = PORT, @period, @firings, @element = f64 or c64");
  }
}

}  // namespace bodeflow::testing
