// The graph loader on arbitrary texts: no crash, no endless loop, and what it accepts expands to a text that loads to the same.
// Lines `--set PATH=VALUE` at the beginning are overrides.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "registry.hpp"

using namespace bodeflow::graph;

namespace {

constexpr const char* kSet = "--set ";

void take_overrides(std::string& text, LoadOptions& options) {
  while (text.compare(0, 6, kSet) == 0) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string line = text.substr(6, end - 6);
    const auto equals = std::min(line.find('='), line.size());
    options.overrides.emplace_back(line.substr(0, equals), equals < line.size() ? line.substr(equals + 1) : "");
    text.erase(0, std::min(end + 1, text.size()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  LoadOptions options;
  take_overrides(text, options);
  const auto graph = load_text(text, "g.yaml", options, test_registry());
  if (!graph) {
    if (bodeflow::to_string(graph.error()).empty()) std::abort();
    return 0;
  }
  const auto again = load_text(graph->expanded, "g.yaml", {}, test_registry());
  if (!again) std::fprintf(stderr, "%s\n%s\n", bodeflow::to_string(again.error()).c_str(), graph->expanded.c_str());
  if (!again || again->expanded != graph->expanded || again->phases.size() != graph->phases.size()) std::abort();
  for (std::size_t i = 0; i < graph->phases.size(); ++i) {
    const auto &a = graph->phases[i], &b = again->phases[i];
    if (a.blocks.size() != b.blocks.size() || a.streams.size() != b.streams.size() || a.messages.size() != b.messages.size())
      std::abort();
    for (std::size_t k = 0; k < a.blocks.size(); ++k)
      if (a.blocks[k].parameters != b.blocks[k].parameters) std::abort();
  }
  return 0;
}
