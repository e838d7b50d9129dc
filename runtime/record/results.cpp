#include "record/results.hpp"

#include <algorithm>

#include "record/run_directory.hpp"

namespace bodeflow::record {
namespace {

std::string result_key(const std::string& phase, const std::string& block, const std::string& port) {
  std::string key = phase.empty() ? block : phase + "." + block;
  if (!port.empty()) key += "." + port;
  return key;
}

}  // namespace

Results::Results(const graph::Graph& graph) {
  for (const auto& phase : graph.phases) {
    for (const auto& block : phase.blocks) {
      const int outputs = block.type->count(BF_MESSAGE, BF_OUT);
      for (int i = 0; i < outputs; ++i) {
        const std::string& port = block.type->port_at(BF_MESSAGE, BF_OUT, i).name;
        entries_.push_back({phase.name, block.name, port, result_key(phase.name, block.name, i == 0 ? "" : port), {}});
      }
    }
  }
}

const Results::Entry* Results::find(const std::string& phase, const std::string& block, const std::string& port) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.phase == phase && entry.block == block && (port.empty() || entry.port == port);
  });
  return found == entries_.end() ? nullptr : &*found;
}

SharedRecord Results::last(const std::string& phase, const std::string& block, const std::string& port) const {
  const Entry* entry = find(phase, block, port);
  return entry == nullptr ? SharedRecord() : entry->record;
}

void Results::set(const std::string& phase, const std::string& block, const std::string& port, const SharedRecord& record) {
  if (const Entry* entry = find(phase, block, port))
    entries_[static_cast<std::size_t>(entry - entries_.data())].record = record;
  else
    entries_.push_back({phase, block, port, result_key(phase, block, port), record});
}

nlohmann::ordered_json Results::json() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& entry : entries_)
    if (entry.record) json[entry.key] = to_json(entry.record);
  return json;
}

}  // namespace bodeflow::record
