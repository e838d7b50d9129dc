#include "plugins/instance.hpp"

#include <fmt/format.h>

#include <utility>

#include "plugins/crash.hpp"
#include "plugins/host.hpp"
#include "plugins/stream_facts.hpp"

namespace bodeflow {

struct Instance::State {
  State(std::string name, std::shared_ptr<const HostServices> services, std::shared_ptr<PartShelf> parts)
      : block_name(name), host(std::move(name), std::move(services), std::move(parts)) {}

  std::string block_name;
  std::shared_ptr<const void> keep;  // libraries and descriptions
  const BlockDescription* type = nullptr;
  Host host;
  bf_block block{};

  AtWork at_work() const {
    return AtWork([](const void* state) { return static_cast<const State*>(state)->known(); }, this);
  }
  AtWork::Block known() const { return {block_name.c_str(), type == nullptr ? "" : type->id.c_str()}; }

  /// Calls a function of the block; its words where it failed.
  template <class Call>
  Result call(const char* function, Call&& call) {
    host.clear_error();
    const AtWork here = at_work();
    try {
      if (call() == BF_OK) return {};
    } catch (...) {
      return tl::unexpected(fmt::format("an exception left the plugin's function '{}'", function));
    }
    return tl::unexpected(host.take_error());
  }
};

namespace {

/// What a made block lacks, or "".
std::string problem_of(const bf_block& block) {
  if (block.struct_size < sizeof(bf_block)) {
    return fmt::format("made a bf_block of {} bytes, at least {} expected", block.struct_size, sizeof(bf_block));
  }
  const std::pair<const char*, bool> functions[] = {
      {"configure", block.configure != nullptr}, {"resolve", block.resolve != nullptr},
      {"activate", block.activate != nullptr},   {"process", block.process != nullptr},
      {"change", block.change != nullptr},       {"finish", block.finish != nullptr},
      {"reset", block.reset != nullptr},         {"deactivate", block.deactivate != nullptr},
      {"destroy", block.destroy != nullptr}};
  for (const auto& [name, there] : functions) {
    if (!there) return fmt::format("made a block without the function '{}'", name);
  }
  return {};
}

}  // namespace

Instance::Instance() = default;

Instance::~Instance() {
  if (state_ == nullptr || state_->block.destroy == nullptr) return;
  try {
    state_->block.destroy(state_->block.self);
  } catch (...) {  // nobody is left to tell
  }
}

tl::expected<std::unique_ptr<Instance>, std::string> Instance::make(Registry& registry, const std::string& id, std::string name,
                                                                    std::shared_ptr<const HostServices> services) {
  std::unique_ptr<Instance> instance(new Instance);
  instance->state_ = std::make_unique<State>(std::move(name), std::move(services), registry.parts());
  State& state = *instance->state_;
  state.type = registry.find(id);
  const AtWork here = state.at_work();
  auto block = registry.create(id, state.host.c());
  if (!block) return tl::unexpected(block.error());
  state.block = *block;
  state.keep = registry.keep_alive();
  if (const std::string why = problem_of(state.block); !why.empty()) {
    return tl::unexpected(fmt::format("plugin '{}' ({}): {}", registry.plugin_of(id)->name, registry.plugin_of(id)->file, why));
  }
  return instance;
}

std::unique_ptr<Instance> Instance::own(std::string name, const BlockDescription& type,
                                        const std::function<bf_block(const bf_host&)>& make) {
  std::unique_ptr<Instance> instance(new Instance);
  instance->state_ = std::make_unique<State>(std::move(name), nullptr, nullptr);
  instance->state_->type = &type;
  instance->state_->block = make(instance->state_->host.c());
  return instance;
}

const std::string& Instance::name() const { return state_->block_name; }
const BlockDescription& Instance::type() const { return *state_->type; }
const bf_block& Instance::c() const { return state_->block; }
std::string Instance::take_error() { return state_->host.take_error(); }

Instance::Result Instance::configure(const std::vector<ParameterValue>& values) {
  if (values.size() != type().parameters.size()) {
    return tl::unexpected(fmt::format("{} parameter values for {} parameters", values.size(), type().parameters.size()));
  }
  std::vector<ParameterView> views;
  std::vector<bf_parameter_value> c;
  views.reserve(values.size());
  for (const ParameterValue& value : values) c.push_back(views.emplace_back(value).c());
  return state_->call(
      "configure", [&] { return state_->block.configure(state_->block.self, c.data(), static_cast<std::uint32_t>(c.size())); });
}

tl::expected<Resolution, std::string> Instance::resolve(const std::vector<StreamFacts>& inputs) {
  const auto input_count = static_cast<std::size_t>(type().count(BF_STREAM, BF_IN));
  const auto output_count = static_cast<std::size_t>(type().count(BF_STREAM, BF_OUT));
  if (inputs.size() != input_count) return tl::unexpected(fmt::format("facts of {} inputs for {}", inputs.size(), input_count));
  const FactsView input_facts(inputs);
  const bf_stream_facts unknown{sizeof(bf_stream_facts), 0, BF_F64, 0, {0, 1}, -1, "", "", nullptr, nullptr, nullptr, 0};
  std::vector<bf_stream_facts> outputs(output_count, unknown);
  const bf_flow preset{sizeof(bf_flow), 1, 0, nullptr};
  std::vector<bf_flow> input_flows(input_count, preset), output_flows(output_count, preset);
  bf_resolution c{};
  c.struct_size = sizeof c;
  c.input_count = static_cast<std::uint32_t>(input_count);
  c.output_count = static_cast<std::uint32_t>(output_count);
  c.inputs = input_facts.data();
  c.outputs = outputs.data();
  c.input_flows = input_flows.data();
  c.output_flows = output_flows.data();
  if (auto done = state_->call("resolve", [&] { return state_->block.resolve(state_->block.self, &c); }); !done) {
    return tl::unexpected(done.error());
  }
  Resolution resolution;
  for (std::size_t i = 0; i < input_count; ++i) {
    auto flow = owned(input_flows[i], &inputs[i], type().port_at(BF_STREAM, BF_IN, static_cast<int>(i)).name);
    if (!flow) return tl::unexpected(flow.error());
    resolution.input_flows.push_back(std::move(*flow));
  }
  for (std::size_t i = 0; i < output_count; ++i) {
    const std::string& port = type().port_at(BF_STREAM, BF_OUT, static_cast<int>(i)).name;
    auto facts = owned(outputs[i], port);
    if (!facts) return tl::unexpected(facts.error());
    auto flow = owned(output_flows[i], nullptr, port);
    if (!flow) return tl::unexpected(flow.error());
    resolution.outputs.push_back(std::move(*facts));
    resolution.output_flows.push_back(std::move(*flow));
  }
  return resolution;
}

tl::expected<std::vector<AdviceText>, std::string> Instance::advise(const std::vector<StreamFacts>& inputs,
                                                                    const std::vector<StreamFacts>& outputs) {
  std::vector<AdviceText> said;
  if (state_->block.extension == nullptr) return said;
  const auto* advice = static_cast<const bf_advice*>(state_->block.extension(state_->block.self, BF_EXTENSION_ADVICE));
  if (advice == nullptr || advice->struct_size < sizeof(bf_advice) || advice->advise == nullptr) return said;
  const FactsView input_facts(inputs), output_facts(outputs);
  std::vector<bf_stream_facts> written(output_facts.data(), output_facts.data() + outputs.size());
  std::vector<bf_flow> flows(inputs.size() + outputs.size(), bf_flow{sizeof(bf_flow), 1, 0, nullptr});
  bf_resolution c{};
  c.struct_size = sizeof c;
  c.input_count = static_cast<std::uint32_t>(inputs.size());
  c.output_count = static_cast<std::uint32_t>(outputs.size());
  c.inputs = input_facts.data();
  c.outputs = written.data();
  c.input_flows = flows.data();
  c.output_flows = flows.data() + inputs.size();
  const auto tell = [](void* context, std::int32_t level, const char* text) {
    static_cast<std::vector<AdviceText>*>(context)->push_back({level, text == nullptr ? "" : text});
  };
  if (auto done = state_->call("advise", [&] { return advice->advise(state_->block.self, &c, &said, tell); }); !done)
    return tl::unexpected(done.error());
  return said;
}

Instance::Result Instance::activate(const bf_activation& activation) {
  bf_activation c = activation;
  c.struct_size = sizeof c;
  return state_->call("activate", [&] { return state_->block.activate(state_->block.self, &c); });
}

Instance::Result Instance::change(std::uint32_t parameter, const ParameterValue& value) {
  const ParameterView view(value);
  return state_->call("change", [&] { return state_->block.change(state_->block.self, parameter, &view.c()); });
}

Instance::Result Instance::reset() {
  return state_->call("reset", [&] { return state_->block.reset(state_->block.self); });
}

void Instance::deactivate() {
  (void)state_->call("deactivate", [&] {
    state_->block.deactivate(state_->block.self);
    return std::int32_t{BF_OK};
  });
}

}  // namespace bodeflow
