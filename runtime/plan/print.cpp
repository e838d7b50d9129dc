#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "plan/fold.hpp"
#include "plan/names.hpp"
#include "plan/plan.hpp"

namespace bodeflow::plan {
namespace {

class Printer {
 public:
  Printer(const graph::Phase& phase, const Facts& facts, const Plan& plan) : phase_(phase), facts_(facts), plan_(plan) {
    for (const graph::Block& block : phase.blocks) width_ = std::max(width_, block.name.size());
  }

  std::string run() {
    head();
    for (std::size_t i = 0; i < plan_.partitions.size(); ++i) partition(i);
    buffers();
    limits();
    for (const std::string& note : plan_.notes) line("note: {}", note);
    for (const std::string& warning : facts_.warnings) line("warning: {}", warning);
    return std::move(text_);
  }

 private:
  template <typename... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  const std::string& name(int block) const { return phase_.blocks[block].name; }

  void head() {
    const std::string title = phase_.name.empty() ? "plan" : "plan of phase '" + phase_.name + "'";
    if (facts_.period.num == 0) {
      line("{}: {}, no streams", title, count_text(static_cast<std::int64_t>(plan_.partitions.size()), "thread"));
      return;
    }
    line("{}: {}, chunks of {} ({}), latency {}, {} of buffers", title,
         count_text(static_cast<std::int64_t>(plan_.partitions.size()), "thread"), seconds_text(plan_.chunk_s),
         count_text(plan_.repetitions, "period"), seconds_text(plan_.latency_s), bytes_text(plan_.bytes));
  }

  void partition(std::size_t index) {
    const Partition& partition = plan_.partitions[index];
    line("");
    line("thread {}: {} of declared work a chunk, {} of buffers", index + 1,
         seconds_text(partition.cost_ns * 1e-9 * static_cast<double>(plan_.repetitions)), bytes_text(partition.arena_bytes));
    for (const Step& step : partition.steps) {
      if (step.kind == Step::Kind::call) {
        call(step.block, "  ");
      } else if (step.kind == Step::Kind::copy) {
        line("  copy buffer {} to {}: the delayed edge has initial values of its own", step.from_buffer, step.to_buffer);
      } else {
        loop(step);
      }
    }
  }

  std::string end_text(int block) const {
    const std::int64_t firings = facts_.blocks[block].firings;
    return firings < 0 ? "without end" : fmt::format("{} in all", firings);
  }

  void call(int block, const char* indent) {
    const Facts::Block& facts = facts_.blocks[block];
    if (facts.repetitions == 0) {
      line("{}{:{}}  {}, with each record", indent, name(block), width_, phase_.blocks[block].type->id);
      return;
    }
    line("{}{:{}}  {}, {}: {}, {}{}", indent, name(block), width_, phase_.blocks[block].type->id, rate_text(facts.firing_rate),
         count_text(facts.repetitions * plan_.repetitions, "firing"), end_text(block), outputs(block));
  }

  std::string outputs(int block) const {
    std::string text;
    for (std::size_t port = 0; port < plan_.outputs[block].size(); ++port) {
      const StreamFacts& facts = facts_.blocks[block].outputs[port];
      const PortDescription& described = phase_.blocks[block].type->port_at(BF_STREAM, BF_OUT, static_cast<int>(port));
      text += fmt::format("; {}: {} {} x {}{} -> buffer {}", described.name, rate_text(facts.rate), element_text(facts.element),
                          facts.channels, facts.unit.empty() ? "" : " [" + facts.unit + "]", plan_.outputs[block][port].buffer);
    }
    return text;
  }

  void loop(const Step& step) {
    std::string turns;
    for (const Fold& fold : fold_schedule(step.schedule)) {
      std::string part;
      for (const Firing& firing : fold.firings) {
        part += (part.empty() ? "" : ", ") + name(firing.block);
        if (firing.to_buffer >= 0) part += fmt::format(" (copy to buffer {})", firing.to_buffer);
        if (firing.to_buffer < 0 && firing.count > 1) part += fmt::format(" x {}", firing.count);
      }
      turns += (turns.empty() ? "" : ", ") + (fold.times > 1 ? fmt::format("{} x ({})", fold.times, part) : part);
    }
    line("  loop, a pass is {}: {}",
         seconds_text(facts_.period.hz() * static_cast<double>(step.repetitions) / static_cast<double>(step.parts)), turns);
    std::vector<int> shown;
    for (const Firing& firing : step.schedule) {
      if (std::find(shown.begin(), shown.end(), firing.block) != shown.end()) continue;
      shown.push_back(firing.block);
      call(firing.block, "    ");
    }
  }

  void buffers() {
    if (plan_.buffers.empty()) return;
    line("");
    line("buffers:");
    std::vector<std::string> source(plan_.buffers.size(), "copy");
    for (int block = 0; block < static_cast<int>(plan_.outputs.size()); ++block) {
      for (int port = 0; port < static_cast<int>(plan_.outputs[block].size()); ++port) {
        source[plan_.outputs[block][port].buffer] = stream_output(phase_, {block, port});
      }
    }
    for (std::size_t i = 0; i < plan_.buffers.size(); ++i) {
      const Buffer& buffer = plan_.buffers[i];
      std::string more;
      if (buffer.history > 0) more += fmt::format(", history of {}", buffer.history);
      if (buffer.slots > 1) more += fmt::format(", ring of {} chunks", buffer.slots);
      line("  {}: {}, {} x {}{}, {} at {} of thread {}", i, source[i],
           count_text(static_cast<std::int64_t>(buffer.capacity), "sample"), count_text(buffer.channels, "channel"), more,
           bytes_text(buffer.bytes), buffer.arena_offset, buffer.partition + 1);
    }
  }

  void limits() {
    if (plan_.limits.empty()) return;
    line("");
    line("limits:");
    for (const Limit& limit : plan_.limits) line("  {}", to_text(limit));
  }

  const graph::Phase& phase_;
  const Facts& facts_;
  const Plan& plan_;
  std::size_t width_ = 0;
  std::string text_;
};

}  // namespace

std::string to_text(const graph::Phase& phase, const Facts& facts, const Plan& plan) { return Printer(phase, facts, plan).run(); }

}  // namespace bodeflow::plan
