#include <nlohmann/json.hpp>

#include "plan/fold.hpp"
#include "plan/names.hpp"
#include "plan/plan.hpp"

namespace bodeflow::plan {
namespace {

using Json = nlohmann::json;

/// A fraction as decimal value and exactly.
Json fraction_json(const Rate& rate) { return {{"value", rate.hz()}, {"num", rate.num}, {"den", rate.den}}; }

Json stream_json(const StreamFacts& facts) {
  return {{"element", element_text(facts.element)},
          {"channels", facts.channels},
          {"rate_hz", fraction_json(facts.rate)},
          {"length", facts.length},
          {"unit", facts.unit},
          {"clock", facts.clock}};
}

Json port_json(const std::string& name, const StreamFacts& facts, const Flow& flow, const Use& use) {
  Json json = facts.known ? stream_json(facts) : Json::object();
  json["port"] = name;
  json["samples"] = flow.samples;
  json["buffer"] = use.buffer;
  return json;
}

Json block_json(const graph::Phase& phase, const Facts& facts, const Plan& plan, int index) {
  const graph::Block& block = phase.blocks[index];
  const Facts::Block& known = facts.blocks[index];
  Json json{{"name", block.name},
            {"block", block.type->id},
            {"rate_hz", fraction_json(known.firing_rate)},
            {"repetitions", known.repetitions},
            {"firings", known.firings},
            {"thread", plan.partition_of[index]},
            {"inputs", Json::array()},
            {"outputs", Json::array()}};
  for (std::size_t i = 0; i < known.inputs.size(); ++i) {
    const Use& use = plan.inputs[index][i];
    json["inputs"].push_back(
        port_json(block.type->port_at(BF_STREAM, BF_IN, static_cast<int>(i)).name, known.inputs[i], known.input_flows[i], use));
    json["inputs"].back()["delay"] = use.delay;
  }
  for (std::size_t i = 0; i < known.outputs.size(); ++i) {
    json["outputs"].push_back(port_json(block.type->port_at(BF_STREAM, BF_OUT, static_cast<int>(i)).name, known.outputs[i],
                                        known.output_flows[i], plan.outputs[index][i]));
  }
  return json;
}

Json schedule_json(const graph::Phase& phase, const std::vector<Firing>& schedule) {
  Json folds = Json::array();
  for (const Fold& fold : fold_schedule(schedule)) {
    Json firings = Json::array();
    for (const Firing& firing : fold.firings) {
      Json entry{{"block", phase.blocks[firing.block].name}, {"count", firing.count}};
      if (firing.to_buffer >= 0) entry["copy"] = {firing.from_buffer, firing.to_buffer};
      firings.push_back(std::move(entry));
    }
    folds.push_back({{"times", fold.times}, {"firings", std::move(firings)}});
  }
  return folds;
}

Json step_json(const graph::Phase& phase, const Step& step) {
  switch (step.kind) {
    case Step::Kind::call:
      return {{"kind", "call"}, {"block", phase.blocks[step.block].name}};
    case Step::Kind::copy:
      return {{"kind", "copy"}, {"from", step.from_buffer}, {"to", step.to_buffer}};
    case Step::Kind::cluster:
      break;
  }
  return {{"kind", "loop"},
          {"repetitions", step.repetitions},
          {"parts", step.parts},
          {"schedule", schedule_json(phase, step.schedule)}};
}

Json thread_json(const graph::Phase& phase, const Partition& partition) {
  Json steps = Json::array();
  for (const Step& step : partition.steps) steps.push_back(step_json(phase, step));
  return {{"arena_bytes", partition.arena_bytes}, {"cost_ns", partition.cost_ns}, {"steps", std::move(steps)}};
}

Json buffer_json(const Buffer& buffer, const std::vector<int>& readers) {
  return {{"element", element_text(buffer.element)},
          {"channels", buffer.channels},
          {"history", buffer.history},
          {"capacity", buffer.capacity},
          {"slots", buffer.slots},
          {"offset", buffer.arena_offset},
          {"bytes", buffer.bytes},
          {"thread", buffer.partition},
          {"reader_threads", readers}};
}

}  // namespace

nlohmann::json to_json(const graph::Phase& phase, const Facts& facts, const Plan& plan) {
  Json json{{"phase", phase.name},
            {"period_s", fraction_json(facts.period)},
            {"repetitions", plan.repetitions},
            {"chunk_s", plan.chunk_s},
            {"latency_s", plan.latency_s},
            {"bytes", plan.bytes},
            {"notes", plan.notes},
            {"warnings", facts.warnings},
            {"blocks", Json::array()},
            {"buffers", Json::array()},
            {"order", Json::array()},
            {"limits", Json::array()},
            {"threads", Json::array()}};
  for (int i = 0; i < static_cast<int>(phase.blocks.size()); ++i) json["blocks"].push_back(block_json(phase, facts, plan, i));
  for (std::size_t i = 0; i < plan.buffers.size(); ++i) json["buffers"].push_back(buffer_json(plan.buffers[i], plan.readers[i]));
  for (const int block : plan.order) json["order"].push_back(phase.blocks[block].name);
  for (const Limit& limit : plan.limits) json["limits"].push_back(to_json(limit));
  for (const Partition& partition : plan.partitions) json["threads"].push_back(thread_json(phase, partition));
  return json;
}

}  // namespace bodeflow::plan
