#include <algorithm>
#include <cstdio>
#include <cstring>

#include "rig.hpp"

namespace bodeflow::testing {
namespace {

std::string value_text(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  double value = 0.0;
  std::memcpy(&value, bytes.data() + at, std::min<std::size_t>(sizeof value, bytes.size() - at));
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::vector<const char*> names(const Case& the_case, std::uint32_t kind, std::uint32_t direction) {
  std::vector<const char*> list;
  for (std::uint32_t i = 0; i < the_case.block->port_count; ++i) {
    const bf_port_descriptor* p = the_case.block->ports[i];
    if (p->kind == kind && p->direction == direction) list.push_back(p->name);
  }
  return list;
}

std::string record_difference(const Case& the_case, const Trace& first, const std::string& a, const Trace& second,
                              const std::string& b) {
  const auto ports = names(the_case, BF_MESSAGE, BF_OUT);
  for (std::size_t i = 0; i < std::min(first.records.size(), second.records.size()); ++i) {
    const SentRecord &x = first.records[i], &y = second.records[i];
    const std::string which = "record " + std::to_string(i) + " on '" + ports[x.port] + "'";
    if (x.port != y.port) return which + " goes to another port with " + b;
    if (x.position != y.position) {
      return which + " is sent at firing " + std::to_string(x.position) + " with " + a + ", at " + std::to_string(y.position) +
             " with " + b + " (give emit the offset)";
    }
    if (x.bytes != y.bytes) return which + " differs between " + a + " and " + b;
  }
  if (first.records.size() != second.records.size()) {
    return std::to_string(first.records.size()) + " records with " + a + ", " + std::to_string(second.records.size()) + " with " +
           b;
  }
  return {};
}

}  // namespace

std::string difference(const Case& the_case, const Trace& first, const std::string& a, const Trace& second,
                       const std::string& b) {
  if (first.failure != second.failure) {
    const auto said = [](const Trace& t) { return t.failure.empty() ? std::string("no failure") : "'" + t.failure + "'"; };
    return said(first) + " with " + a + ", " + said(second) + " with " + b;
  }
  if (!first.failure.empty()) return {};
  if (first.firings != second.firings) {
    return std::to_string(first.firings) + " firings with " + a + ", " + std::to_string(second.firings) + " with " + b;
  }
  const auto ports = names(the_case, BF_STREAM, BF_OUT);
  for (std::size_t o = 0; o < first.outputs.size(); ++o) {
    for (std::size_t c = 0; c < first.outputs[o].size(); ++c) {
      const auto &x = first.outputs[o][c], &y = second.outputs[o][c];
      const auto places = std::mismatch(x.begin(), x.end(), y.begin(), y.end());
      if (places.first == x.end() && places.second == y.end()) continue;
      const auto at = static_cast<std::size_t>(places.first - x.begin()) / 8 * 8;
      return std::string("output '") + ports[o] + "', channel " + std::to_string(c) + ", value " + std::to_string(at / 8) +
             " is " + value_text(x, at) + " with " + a + ", " + value_text(y, at) + " with " + b;
    }
  }
  return record_difference(the_case, first, a, second, b);
}

}  // namespace bodeflow::testing
