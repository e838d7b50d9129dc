#include "net.hpp"

#include <algorithm>
#include <map>

namespace bodeflow::test {

StreamFacts stream(Rate rate, std::int64_t length, std::uint32_t channels) {
  StreamFacts facts;
  facts.known = true;
  facts.channels = channels;
  facts.rate = rate;
  facts.length = length;
  return facts;
}

Net::Resolve siso(std::uint32_t up, std::uint32_t down, std::uint64_t delay, std::vector<double> initial) {
  return [=](const std::vector<StreamFacts>& in) -> tl::expected<Resolution, std::string> {
    Resolution r{{in[0]}, {{down, delay, initial}}, {{up, 0, {}}}};
    r.outputs[0].rate = in[0].rate.scaled(up, down);
    if (in[0].length >= 0) r.outputs[0].length = in[0].length / down * up;
    return r;
  };
}

int Net::add(const std::string& name, std::vector<std::string> in, std::vector<std::string> out, Resolve resolve,
             std::vector<std::string> message_in, std::vector<std::string> message_out) {
  BlockDescription& type = types_.emplace_back();
  type.id = "test." + name;
  type.cost_ns = 1000.0;
  const auto ports = [&](const std::vector<std::string>& names, std::uint32_t kind, std::uint32_t direction) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      PortDescription port;
      port.kind = kind;
      port.direction = direction;
      port.name = names[i];
      port.index = static_cast<int>(i);
      type.ports.push_back(port);
    }
  };
  ports(in, BF_STREAM, BF_IN);
  ports(out, BF_STREAM, BF_OUT);
  ports(message_in, BF_MESSAGE, BF_IN);
  ports(message_out, BF_MESSAGE, BF_OUT);
  graph::Block block;
  block.name = name;
  block.type = &type;
  block.place = {"g.yaml", static_cast<int>(phase.blocks.size()) + 1, 3};
  phase.blocks.push_back(block);
  resolves_.push_back(std::move(resolve));
  return static_cast<int>(phase.blocks.size()) - 1;
}

int Net::source(const std::string& name, Rate rate, std::int64_t length, std::uint32_t channels) {
  return add(name, {}, {"out"}, [=](const auto&) { return Resolution{{stream(rate, length, channels)}, {}, {Flow{}}}; });
}

int Net::gain(const std::string& name) { return add(name, {"in"}, {"out"}, siso()); }
int Net::lag(const std::string& name, std::uint64_t delay, std::vector<double> initial) {
  return add(name, {"in"}, {"out"}, siso(1, 1, delay, std::move(initial)));
}
int Net::hold(const std::string& name, std::uint32_t factor) { return add(name, {"in"}, {"out"}, siso(factor, 1)); }
int Net::decimate(const std::string& name, std::uint32_t factor) { return add(name, {"in"}, {"out"}, siso(1, factor)); }

int Net::sum(const std::string& name) {
  return add(name, {"in", "feedback"}, {"out"}, [](const std::vector<StreamFacts>& in) {
    return Resolution{{in[0].known ? in[0] : in[1]}, {Flow{}, Flow{}}, {Flow{}}};
  });
}

int Net::sink(const std::string& name) {
  return add(name, {"in"}, {}, [](const auto&) { return Resolution{{}, {Flow{}}, {}}; });
}

int Net::estimator(const std::string& name) {
  return add(name, {"in"}, {}, [](const auto&) { return Resolution{{}, {Flow{}}, {}}; }, {}, {"model"});
}

int Net::designer(const std::string& name) {
  return add(name, {}, {}, [](const auto&) { return Resolution{}; }, {"model"}, {"controller"});
}

graph::End Net::find(const std::string& text, std::uint32_t kind, std::uint32_t direction) const {
  const std::size_t dot = text.find('.');
  graph::End end;
  for (std::size_t i = 0; i < phase.blocks.size(); ++i) {
    if (phase.blocks[i].name == text.substr(0, dot)) end.block = static_cast<int>(i);
  }
  if (dot == std::string::npos) return end;
  const std::string name = text.substr(dot + 1);
  if (name == "parameters") {
    end.port = graph::kParameterPort;
    return end;
  }
  for (const PortDescription& port : types_[static_cast<std::size_t>(end.block)].ports) {
    if (port.kind == kind && port.direction == direction && port.name == name) end.port = port.index;
  }
  return end;
}

void Net::connect(const std::string& from, const std::string& to) {
  phase.streams.push_back(
      {find(from, BF_STREAM, BF_OUT), find(to, BF_STREAM, BF_IN), {"g.yaml", 100 + static_cast<int>(phase.streams.size()), 5}});
}

void Net::tell(const std::string& from, const std::string& to, graph::Latency latency) {
  phase.messages.push_back({find(from, BF_MESSAGE, BF_OUT),
                            find(to, BF_MESSAGE, BF_IN),
                            latency,
                            {"g.yaml", 200 + static_cast<int>(phase.messages.size()), 5}});
}

tl::expected<plan::Facts, Problems> Net::try_facts() const {
  return plan::establish_facts(phase, [this](int block, const std::vector<StreamFacts>& inputs) {
    auto resolution = resolves_[static_cast<std::size_t>(block)](inputs);
    for (const auto& [end, samples] : more_delay) {
      if (resolution && end.block == block) resolution->input_flows[static_cast<std::size_t>(end.port)].delay += samples;
    }
    return resolution;
  });
}

plan::Facts Net::facts() const {
  auto facts = try_facts();
  if (!facts) FAIL(to_string(facts.error()));
  return std::move(*facts);
}

tl::expected<plan::Plan, Problems> Net::try_plan(const plan::PlanOptions& options) const {
  return plan::make_plan(phase, facts(), options);
}

plan::Plan Net::plan(const plan::PlanOptions& options) const {
  const plan::Facts known = facts();
  auto plan = plan::make_plan(phase, known, options);
  if (!plan) FAIL(to_string(plan.error()));
  check_order_of_work(phase, known, *plan);
  check_memory(phase, *plan, options.kept);
  return std::move(*plan);
}

plan::Plan Net::plan(std::int64_t chunk) const {
  plan::PlanOptions options;
  options.chunk = chunk;
  return plan(options);
}

namespace {

/// Counts samples per buffer as an executor would move them.
class Counting {
 public:
  Counting(const graph::Phase& phase, const plan::Facts& facts, const plan::Plan& plan)
      : phase_(phase), facts_(facts), plan_(plan), made_(phase.blocks.size(), 0), written_(plan.buffers.size(), 0) {}

  void run(std::int64_t chunks, std::int64_t periods) {
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
      target_periods_ += periods;
      for (const plan::Partition& partition : plan_.partitions) {
        for (const plan::Step& step : partition.steps) work(step, periods);
      }
      for (std::size_t block = 0; block < made_.size(); ++block) {
        INFO("block " << phase_.blocks[block].name);
        REQUIRE(made_[block] == target_periods_ * facts_.blocks[block].repetitions);
      }
    }
  }

 private:
  std::size_t at(int index) const { return static_cast<std::size_t>(index); }

  void work(const plan::Step& step, std::int64_t periods) {
    if (step.kind == plan::Step::Kind::call) {
      fire(step.block, facts_.blocks[at(step.block)].repetitions * periods);
    } else if (step.kind == plan::Step::Kind::copy) {
      written_[at(step.to_buffer)] = written_[at(step.from_buffer)];
    } else {
      const std::int64_t passes = (periods * step.parts + step.repetitions - 1) / step.repetitions;
      for (std::int64_t pass = 0; pass < passes; ++pass) {
        for (const plan::Firing& firing : step.schedule) {
          if (firing.to_buffer >= 0) {
            written_[at(firing.to_buffer)] = written_[at(firing.from_buffer)];
            continue;
          }
          const std::int64_t left = target_periods_ * facts_.blocks[at(firing.block)].repetitions - made_[at(firing.block)];
          fire(firing.block, std::min(left, firing.count));
        }
      }
    }
  }

  void fire(int block, std::int64_t count) {
    const plan::Facts::Block& known = facts_.blocks[at(block)];
    INFO("block " << phase_.blocks[at(block)].name << ", firing " << made_[at(block)] << " x " << count);
    for (std::size_t port = 0; port < known.inputs.size(); ++port) {
      const plan::Use& use = plan_.inputs[at(block)][port];
      if (use.buffer < 0) continue;
      REQUIRE(use.delay <= plan_.buffers[at(use.buffer)].history);
      const auto last = (made_[at(block)] + count) * known.input_flows[port].samples - static_cast<std::int64_t>(use.delay);
      REQUIRE(last <= written_[at(use.buffer)]);
    }
    made_[at(block)] += count;
    for (std::size_t port = 0; port < known.outputs.size(); ++port) {
      const int buffer = plan_.outputs[at(block)][port].buffer;
      written_[at(buffer)] += count * known.output_flows[port].samples;
    }
  }

  const graph::Phase& phase_;
  const plan::Facts& facts_;
  const plan::Plan& plan_;
  std::int64_t target_periods_ = 0;
  std::vector<std::int64_t> made_, written_;
};

}  // namespace

void check_order_of_work(const graph::Phase& phase, const plan::Facts& facts, const plan::Plan& plan) {
  Counting(phase, facts, plan).run(3, plan.repetitions);
  if (plan.repetitions > 1) Counting(phase, facts, plan).run(3, plan.repetitions - 1);
}

void check_memory(const graph::Phase& phase, const plan::Plan& plan, const std::vector<graph::End>& kept) {
  std::map<int, std::pair<int, int>> life;  // by buffer, steps of its partition
  for (std::size_t p = 0; p < plan.partitions.size(); ++p) {
    const auto& steps = plan.partitions[p].steps;
    for (int i = 0; i < static_cast<int>(steps.size()); ++i) {
      std::vector<int> used{steps[static_cast<std::size_t>(i)].from_buffer, steps[static_cast<std::size_t>(i)].to_buffer};
      const auto add_block = [&](int block) {
        for (const auto* uses : {&plan.inputs, &plan.outputs}) {
          for (const plan::Use& use : (*uses)[static_cast<std::size_t>(block)]) used.push_back(use.buffer);
        }
      };
      if (steps[static_cast<std::size_t>(i)].kind == plan::Step::Kind::call) add_block(steps[static_cast<std::size_t>(i)].block);
      for (const plan::Firing& firing : steps[static_cast<std::size_t>(i)].schedule) add_block(firing.block);
      for (const int buffer : used) {
        if (buffer < 0 || plan.buffers[static_cast<std::size_t>(buffer)].partition != static_cast<int>(p)) continue;
        auto [found, fresh] = life.try_emplace(buffer, i, i);
        if (!fresh) found->second.second = i;
      }
    }
  }
  for (auto& [index, span] : life) {
    const plan::Buffer& buffer = plan.buffers[static_cast<std::size_t>(index)];
    if (buffer.history > 0 || buffer.slots > 1) span = {-1, 1 << 30};
    REQUIRE(buffer.arena_offset % 64 == 0);
    REQUIRE(buffer.arena_offset + buffer.bytes <= plan.partitions[static_cast<std::size_t>(buffer.partition)].arena_bytes);
  }
  for (const graph::End& end : kept) {
    life[plan.outputs[static_cast<std::size_t>(end.block)][static_cast<std::size_t>(end.port)].buffer].second = 1 << 30;
  }
  const auto passes_on = [&](int from, int to) {  // `to` is what an in-place block makes of `from`
    for (std::size_t block = 0; block < phase.blocks.size(); ++block) {
      if (!phase.blocks[block].type->in_place) continue;
      for (std::size_t port = 0; port < std::min(plan.inputs[block].size(), plan.outputs[block].size()); ++port) {
        if (plan.inputs[block][port].buffer == from && plan.outputs[block][port].buffer == to) return true;
      }
    }
    return false;
  };
  for (const auto& [a, in_a] : life) {
    for (const auto& [b, in_b] : life) {
      const plan::Buffer &x = plan.buffers[static_cast<std::size_t>(a)], &y = plan.buffers[static_cast<std::size_t>(b)];
      if (a == b || x.partition != y.partition || in_a.first > in_b.second || in_b.first > in_a.second) continue;
      const bool apart = x.arena_offset + x.bytes <= y.arena_offset || y.arena_offset + y.bytes <= x.arena_offset;
      const bool handed_over = in_a.second == in_b.first && passes_on(a, b);
      const bool taken_over = in_b.second == in_a.first && passes_on(b, a);
      INFO("buffers " << a << " and " << b);
      REQUIRE((apart || handed_over || taken_over));
    }
  }
}

std::string text_of(const graph::Phase& phase, const plan::Step& step) {
  std::string text;
  for (const plan::Firing& firing : step.schedule) {
    text += (text.empty() ? "" : ", ") + phase.blocks[static_cast<std::size_t>(firing.block)].name;
    if (firing.to_buffer >= 0) text += " copied";
    if (firing.count != 1) text += " x" + std::to_string(firing.count);
  }
  return text;
}

}  // namespace bodeflow::test
