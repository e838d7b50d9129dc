#include "live/state_json.hpp"

#include <fmt/format.h>

#include <bodeflow/record_view.hpp>

#include "graph/value.hpp"
#include "record/recorder.hpp"

namespace bodeflow::tools::live {
namespace {

using nlohmann::ordered_json;
using observe::Change;
using observe::Look;

ordered_json rate_json(const Rate& rate) { return rate.known() ? ordered_json(rate.hz()) : ordered_json(nullptr); }

const graph::Block& block_of(const Look& look, int block) { return look.facts->phase->blocks[static_cast<std::size_t>(block)]; }

std::string port_text(const Look& look, graph::End end, std::uint32_t kind, std::uint32_t direction) {
  const graph::Block& block = block_of(look, end.block);
  if (end.port == graph::kParameterPort) return block.name + ".parameters";
  return block.name + "." + block.type->port_at(kind, direction, end.port).name;
}

ordered_json blocks_json(const Look& look) {
  ordered_json blocks = ordered_json::array();
  const auto& facts = look.facts->facts.blocks;
  for (std::size_t b = 0; b < look.facts->phase->blocks.size(); ++b) {
    const graph::Block& block = look.facts->phase->blocks[b];
    ordered_json json{{"name", block.name}, {"type", block.type->id}};
    if (b < facts.size() && facts[b].repetitions > 0) json["rate_hz"] = rate_json(facts[b].firing_rate);
    if (b < look.state.firings.size() && facts[b].repetitions > 0) json["firings"] = look.state.firings[b];
    if (b < look.facts->thread_of.size()) json["thread"] = look.facts->thread_of[b] + 1;
    if (b < look.counts.size()) {
      std::uint64_t sent = 0;
      for (const std::uint64_t count : look.counts[b]) sent += count;
      if (!look.counts[b].empty()) json["records"] = sent;
    }
    if (b < look.state.waiting.size() && look.state.waiting[b] >= 0) json["waiting"] = look.state.waiting[b];
    blocks.push_back(std::move(json));
  }
  return blocks;
}

ordered_json streams_json(const Look& look) {
  ordered_json streams = ordered_json::array();
  for (const auto& edge : look.facts->phase->streams) {
    ordered_json json{{"from", port_text(look, edge.from, BF_STREAM, BF_OUT)},
                      {"to", port_text(look, edge.to, BF_STREAM, BF_IN)}};
    if (const auto& blocks = look.facts->facts.blocks; !blocks.empty()) {
      const auto& block = blocks[static_cast<std::size_t>(edge.from.block)];
      const StreamFacts& facts = block.outputs[static_cast<std::size_t>(edge.from.port)];
      json["rate_hz"] = rate_json(facts.rate);
      json["channels"] = facts.channels;
      json["unit"] = facts.unit;
      json["block"] = edge.from.block;
      json["samples"] = block.output_flows[static_cast<std::size_t>(edge.from.port)].samples;
    }
    for (const auto& ring : look.state.rings)
      if (ring.from == edge.from.block && ring.to == edge.to.block && ring.port == edge.to.port)
        json["ring"] = {{"filled", ring.filled}, {"slots", ring.slots}};
    streams.push_back(std::move(json));
  }
  return streams;
}

ordered_json messages_json(const Look& look) {
  ordered_json messages = ordered_json::array();
  for (const auto& edge : look.facts->phase->messages) {
    ordered_json json{{"from", port_text(look, edge.from, BF_MESSAGE, BF_OUT)},
                      {"to", port_text(look, edge.to, BF_MESSAGE, BF_IN)}};
    if (!look.counts.empty())
      json["count"] = look.counts[static_cast<std::size_t>(edge.from.block)][static_cast<std::size_t>(edge.from.port)];
    messages.push_back(std::move(json));
  }
  return messages;
}

ordered_json parameter_json(const graph::Block& block, const ParameterDescription& p, const ParameterValue& value) {
  ordered_json json{{"block", block.name}, {"parameter", p.name}, {"value", record::to_json(value)}};
  json["unit"] = p.unit == "1" ? "" : p.unit;
  json["form"] = graph::allowed_form(p);
  json["range"] = graph::range_text(p);
  json["doc"] = p.doc;
  if (p.type == BF_CHOICE) json["choices"] = p.choices;
  if (p.type == BF_BOOL) json["choices"] = {"true", "false"};
  return json;
}

ordered_json parameters_json(const Look& look) {
  ordered_json parameters = ordered_json::array();
  for (std::size_t b = 0; b < look.values.size(); ++b) {
    const graph::Block& block = look.facts->phase->blocks[b];
    for (std::size_t p = 0; p < look.values[b].size(); ++p)
      if (block.type->parameters[p].live)
        parameters.push_back(parameter_json(block, block.type->parameters[p], look.values[b][p]));
  }
  return parameters;
}

const char* word_of(Change::Status status) {
  switch (status) {
    case Change::Status::taken:
      return "taken";
    case Change::Status::refused:
      return "refused";
    case Change::Status::missed:
      return "missed";
    default:
      return "waiting";
  }
}

ordered_json changes_json(const Look& look) {
  ordered_json changes = ordered_json::array();
  for (const Change& change : look.changes) {
    ordered_json json{{"block", change.block},
                      {"parameter", change.parameter},
                      {"value", record::to_json(change.value)},
                      {"status", word_of(change.status)},
                      {"text", change_text(change)}};
    if (!change.phase.empty()) json["phase"] = change.phase;
    if (change.status == Change::Status::taken) {
      json["position"] = change.position;
      json["time_s"] = change.time_s;
    }
    changes.push_back(std::move(json));
  }
  return changes;
}

ordered_json records_json(const Look& look) {
  ordered_json records = ordered_json::array();
  for (const auto& record : look.records)
    records.push_back({{"key", record.key},
                       {"type", std::string(RecordView(*record.record.c()).type())},
                       {"time_s", record.time_s},
                       {"count", record.count},
                       {"version", record.version}});
  return records;
}

ordered_json lateness_json(const execute::State& state) {
  const execute::Lateness& late = state.lateness;
  if (late.chunks == 0) return nullptr;
  return {{"chunks", late.chunks}, {"min_s", late.min_s}, {"median_s", late.median_s},
          {"p99_s", late.p99_s},   {"max_s", late.max_s}, {"bins", late.bins}};
}

}  // namespace

ordered_json to_json(const Look& look) {
  ordered_json json{{"generation", look.generation}, {"runs", look.runs}};
  json["records"] = records_json(look);
  json["changes"] = changes_json(look);
  if (!look.facts) return json;
  json["phase"] = look.facts->phase->name;
  json["repeat"] = look.facts->repeat;
  json["sweep"] = look.facts->is_sweep;
  json["chunk_s"] = look.facts->chunk_s;
  const execute::Progress& progress = look.state.progress;
  json["progress"] = {{"time_s", progress.time_s}, {"total_s", progress.total_s}, {"rate", progress.rate}};
  json["overruns"] = look.state.overruns;
  json["skipped"] = look.state.skipped;
  json["lateness"] = lateness_json(look.state);
  json["blocks"] = blocks_json(look);
  json["streams"] = streams_json(look);
  json["messages"] = messages_json(look);
  json["parameters"] = parameters_json(look);
  return json;
}

std::string change_text(const Change& change) {
  const std::string what = fmt::format("{}.{} = {}", change.block, change.parameter, record::to_json(change.value).dump());
  switch (change.status) {
    case Change::Status::taken:
      return fmt::format("{} from sample {} on ({:.6g} s)", what, change.position, change.time_s);
    case Change::Status::refused:
      return fmt::format("{} refused: {}", what, change.refusal);
    case Change::Status::missed:
      return what + " had no effect: the phase ended before";
    default:
      return what + " is on its way";
  }
}

}  // namespace bodeflow::tools::live
