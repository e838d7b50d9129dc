#include "bench.hpp"

#include <algorithm>
#include <bit>
#include <bodeflow/record.hpp>
#include <cstring>

#include "catch.hpp"
#include "collector.hpp"

namespace bodeflow::test {

Registry& test_registry() {
  static Registry made([] {
    Registry::Options options;
    options.path = {BODEFLOW_FIXTURES};
    options.probe_command = BODEFLOW_PROBE_HELPER;
    return options;
  }());
  return made;
}

namespace {

ParameterValue value_of(const ParameterDescription& described, const Value& value) {
  ParameterValue made;
  made.type = described.type;
  made.given = true;
  made.rows = 1;
  if (const auto* flag = std::get_if<bool>(&value)) made.integer = *flag ? 1 : 0;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) made.integer = *integer;
  if (const auto* number = std::get_if<double>(&value)) made.numbers = {*number};
  if (const auto* text = std::get_if<std::string>(&value)) made.strings = {*text};
  if (const auto* list = std::get_if<std::vector<double>>(&value)) {
    made.numbers = *list;
    made.rows = static_cast<std::uint32_t>(list->size());
  }
  return made;
}

bool same_bits(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

std::string text_of(const Problems& problems) { return to_string(problems); }

}  // namespace

double Sent::value() const {
  const SharedRecord record = SharedRecord::copy(bytes.data(), bytes.size());
  return RecordView(*record.c()).number("value").value_or(-12345.0);
}

std::vector<std::string> Result::said(const std::string& block) const {
  std::vector<std::string> texts;
  for (const auto& [name, text] : log)
    if (name == block) texts.push_back(text);
  return texts;
}

bool Result::same_data(const Result& other) const {
  const auto same_stream = [](const auto& a, const auto& b) { return a.first == b.first && same_bits(a.second, b.second); };
  return streams.size() == other.streams.size() &&
         std::equal(streams.begin(), streams.end(), other.streams.begin(), same_stream) && records == other.records &&
         changes == other.changes;
}

Bench::Bench() {
  phase.name = "test";
  options.watchdog_s = 60.0;
}

int Bench::add(const std::string& name, const std::string& id, const std::map<std::string, Value>& parameters) {
  graph::Block block;
  block.name = name;
  block.type = test_registry().find(id);
  INFO(id);
  for (const auto& plugin : test_registry().plugins()) UNSCOPED_INFO(plugin.file + ": " + plugin.refused);
  REQUIRE(block.type != nullptr);
  for (const auto& described : block.type->parameters) block.parameters.push_back(described.fallback);
  for (const auto& [key, value] : parameters) {
    const int index = block.type->parameter(key);
    INFO(key);
    REQUIRE(index >= 0);
    block.parameters[static_cast<std::size_t>(index)] = value_of(block.type->parameters[static_cast<std::size_t>(index)], value);
  }
  block.parameter_places.resize(block.parameters.size());
  phase.blocks.push_back(block);
  const int index = static_cast<int>(phase.blocks.size()) - 1;
  for (int port = 0; port < block.type->count(BF_STREAM, BF_OUT); ++port) phase.recorded.push_back({{index, port}, BF_STREAM});
  return index;
}

graph::End Bench::find(const std::string& text, std::uint32_t kind, std::uint32_t direction) const {
  const auto dot = text.find('.');
  const int block = phase.block_index(text.substr(0, dot));
  INFO(text);
  REQUIRE(block >= 0);
  if (dot == std::string::npos) return {block, 0};
  const std::string name = text.substr(dot + 1);
  if (kind == BF_MESSAGE && direction == BF_IN && name == "parameters") return {block, graph::kParameterPort};
  const PortDescription* port = phase.blocks[static_cast<std::size_t>(block)].type->port(direction, name);
  REQUIRE(port != nullptr);
  REQUIRE(port->kind == kind);
  return {block, port->index};
}

void Bench::connect(const std::string& from, const std::string& to) {
  phase.streams.push_back({find(from, BF_STREAM, BF_OUT), find(to, BF_STREAM, BF_IN), {}});
}

void Bench::tell(const std::string& from, const std::string& to, graph::Latency latency) {
  phase.messages.push_back({find(from, BF_MESSAGE, BF_OUT), find(to, BF_MESSAGE, BF_IN), latency, {}});
}

void Bench::schedule(double time_s, const std::string& block, const std::string& parameter, const Value& value) {
  const int index = phase.block_index(block);
  const BlockDescription& type = *phase.blocks[static_cast<std::size_t>(index)].type;
  const int which = type.parameter(parameter);
  phase.schedule.push_back({time_s, index, which, value_of(type.parameters[static_cast<std::size_t>(which)], value), {}});
}

graph::Limit& Bench::limit_input(const std::string& signal) {
  graph::Limit limit;
  limit.port = find(signal, BF_STREAM, BF_IN);
  limit.input = true;
  limit.on_violation = graph::OnViolation::clamp;
  return phase.limits.emplace_back(limit);
}

graph::Limit& Bench::limit_output(const std::string& signal) {
  graph::Limit limit;
  limit.port = find(signal, BF_STREAM, BF_OUT);
  return phase.limits.emplace_back(limit);
}

void Bench::give(const std::string& to, double value) {
  RecordBuilder record("number");
  record.set("value", value);
  const auto bytes = record.bytes();
  initial.push_back({find(to, BF_MESSAGE, BF_IN), SharedRecord::copy(bytes.data(), bytes.size())});
}

Result Bench::run(const Cut& cut) {
  std::vector<std::unique_ptr<Instance>> instances;
  return run(cut, instances);
}

Result Bench::run(const Cut& cut, std::vector<std::unique_ptr<Instance>>& instances) {
  Result result;
  auto log_mutex = std::make_shared<std::mutex>();
  auto services = std::make_shared<HostServices>();
  services->log = [&result, log_mutex](const std::string& block, int, const std::string& text) {
    const std::lock_guard lock(*log_mutex);
    result.log.emplace_back(block, text);
  };
  auto made = plan::instantiate(phase, test_registry(), services);
  if (!made) FAIL(text_of(made.error()));
  instances = std::move(*made);
  const auto facts = plan::establish_facts(phase, instances);
  if (!facts) FAIL(text_of(facts.error()));
  plan::PlanOptions wanted;
  wanted.chunk = cut.chunk;
  wanted.threads = cut.threads;
  for (const auto& recorded : phase.recorded) wanted.kept.push_back(recorded.port);
  const auto plan = plan::make_plan(phase, *facts, wanted);
  if (!plan) FAIL(text_of(plan.error()));
  for (const auto& recorded : phase.recorded) {
    const graph::Block& block = phase.blocks[static_cast<std::size_t>(recorded.port.block)];
    const auto& out =
        facts->blocks[static_cast<std::size_t>(recorded.port.block)].outputs[static_cast<std::size_t>(recorded.port.port)];
    result.streams[block.name + "." + block.type->port_at(BF_STREAM, BF_OUT, recorded.port.port).name].resize(out.channels);
  }
  result.threads = plan->partitions.size();
  result.limits = plan->limits;
  Collector sink(phase, on_samples, result);
  execute::Options chosen = options;
  chosen.first_chunk = cut.first_chunk;
  chosen.call_limit = cut.call_limit;
  if (watch == nullptr) {
    result.outcome = execute::execute(phase, *facts, *plan, instances, initial, sink, chosen);
    return result;
  }
  chosen.observer = watch;
  result.outcome =
      execute::execute(phase, *facts, *plan, instances, initial, watch->begin_phase(phase, 0, *facts, *plan, sink), chosen);
  watch->end_phase();
  return result;
}

void Bench::check_identity() {
  const Result reference = run();
  INFO(reference.outcome.reason);
  REQUIRE(reference.outcome.status == execute::Outcome::Status::complete);
  for (const std::int64_t chunk : {1, 7, 64, 256, 1000, 1024}) {
    for (const int threads : {1, 2, 4}) {
      for (const Cut& cut : {Cut{chunk, threads, 0, 0}, Cut{chunk, threads, 1, 0}, Cut{chunk, threads, 3, 5}}) {
        if (chunk == 1 && threads > 1 && cut.first_chunk > 0) continue;  // no shorter chunk than one
        const Result result = run(cut);
        INFO("chunk " << cut.chunk << ", threads " << cut.threads << ", first chunk " << cut.first_chunk << ", call limit "
                      << cut.call_limit << ": " << result.outcome.reason);
        REQUIRE(result.outcome.status == execute::Outcome::Status::complete);
        CHECK(result.same_data(reference));
        if (threads == 2) CHECK(result.threads == 2);
      }
    }
  }
}

}  // namespace bodeflow::test
