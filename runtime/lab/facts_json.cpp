#include "lab/facts_json.hpp"

#include <cstring>

namespace bodeflow::lab {
namespace {

using nlohmann::json;

/// Numbers as their bits: also what JSON has no word for.
json bits_of(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    list.push_back(bits);
  }
  return list;
}

std::vector<double> doubles_from(const json& list) {
  std::vector<double> values;
  for (const json& item : list) {
    const auto bits = item.get<std::uint64_t>();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    values.push_back(value);
  }
  return values;
}

json to_json(const Rate& rate) { return json::array({rate.num, rate.den}); }
Rate rate_from(const json& list) { return {list.at(0).get<std::int64_t>(), list.at(1).get<std::int64_t>()}; }

json flows_json(const std::vector<Flow>& flows) {
  json list = json::array();
  for (const Flow& flow : flows)
    list.push_back({{"samples", flow.samples}, {"delay", flow.delay}, {"initial", bits_of(flow.initial)}});
  return list;
}

std::vector<Flow> flows_from(const json& list) {
  std::vector<Flow> flows;
  for (const json& item : list)
    flows.push_back(
        {item.at("samples").get<std::uint32_t>(), item.at("delay").get<std::uint64_t>(), doubles_from(item.at("initial"))});
  return flows;
}

StreamFacts one_from(const json& item) {
  StreamFacts facts;
  facts.known = item.at("known").get<bool>();
  facts.element = item.at("element").get<std::uint32_t>();
  facts.channels = item.at("channels").get<std::uint32_t>();
  facts.rate = rate_from(item.at("rate"));
  facts.length = item.at("length").get<std::int64_t>();
  facts.unit = item.at("unit").get<std::string>();
  facts.clock = item.at("clock").get<std::string>();
  facts.channel_names = item.at("channel_names").get<std::vector<std::string>>();
  facts.channel_units = item.at("channel_units").get<std::vector<std::string>>();
  for (const auto& [name, values] : item.at("notes").items()) facts.notes[name] = doubles_from(values);
  return facts;
}

}  // namespace

json to_json(const StreamFacts& facts) {
  json notes = json::object();
  for (const auto& [name, values] : facts.notes) notes[name] = bits_of(values);
  return {{"known", facts.known},
          {"element", facts.element},
          {"channels", facts.channels},
          {"rate", to_json(facts.rate)},
          {"length", facts.length},
          {"unit", facts.unit},
          {"clock", facts.clock},
          {"channel_names", facts.channel_names},
          {"channel_units", facts.channel_units},
          {"notes", notes}};
}

json to_json(const std::vector<StreamFacts>& facts) {
  json list = json::array();
  for (const StreamFacts& one : facts) list.push_back(to_json(one));
  return list;
}

json to_json(const Resolution& resolution) {
  return {{"outputs", to_json(resolution.outputs)},
          {"input_flows", flows_json(resolution.input_flows)},
          {"output_flows", flows_json(resolution.output_flows)}};
}

json to_json(const plan::Facts& facts) {
  json blocks = json::array();
  for (const auto& block : facts.blocks)
    blocks.push_back({{"inputs", to_json(block.inputs)},
                      {"outputs", to_json(block.outputs)},
                      {"input_flows", flows_json(block.input_flows)},
                      {"output_flows", flows_json(block.output_flows)},
                      {"firing_rate", to_json(block.firing_rate)},
                      {"repetitions", block.repetitions},
                      {"firings", block.firings}});
  return {{"blocks", blocks}, {"period", to_json(facts.period)}};
}

json to_json(const Problems& problems) {
  json list = json::array();
  for (const Problem& problem : problems)
    list.push_back(
        {{"file", problem.place.file}, {"line", problem.place.line}, {"column", problem.place.column}, {"text", problem.text}});
  return list;
}

std::vector<StreamFacts> stream_facts_from(const json& list) {
  std::vector<StreamFacts> facts;
  for (const json& item : list) facts.push_back(one_from(item));
  return facts;
}

Resolution resolution_from(const json& item) {
  return {stream_facts_from(item.at("outputs")), flows_from(item.at("input_flows")), flows_from(item.at("output_flows"))};
}

plan::Facts facts_from(const json& item) {
  plan::Facts facts;
  facts.period = rate_from(item.at("period"));
  for (const json& one : item.at("blocks")) {
    plan::Facts::Block block;
    block.inputs = stream_facts_from(one.at("inputs"));
    block.outputs = stream_facts_from(one.at("outputs"));
    block.input_flows = flows_from(one.at("input_flows"));
    block.output_flows = flows_from(one.at("output_flows"));
    block.firing_rate = rate_from(one.at("firing_rate"));
    block.repetitions = one.at("repetitions").get<std::int64_t>();
    block.firings = one.at("firings").get<std::int64_t>();
    facts.blocks.push_back(std::move(block));
  }
  return facts;
}

Problems problems_from(const json& list) {
  Problems problems;
  for (const json& item : list)
    problems.push_back({{item.at("file").get<std::string>(), item.at("line").get<int>(), item.at("column").get<int>()},
                        item.at("text").get<std::string>()});
  return problems;
}

}  // namespace bodeflow::lab
