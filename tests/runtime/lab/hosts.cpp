// A phase on several hosts in one process: a thread a host, links in memory.
#include <thread>

#include "../execute/bench.hpp"
#include "../execute/collector.hpp"
#include "catch.hpp"
#include "lab/remote_blocks.hpp"
#include "memory_link.hpp"
#include "plan/facts.hpp"

namespace bodeflow::test {
namespace {

using Instances = std::vector<std::unique_ptr<Instance>>;

/// One host's part with its instances, ready to run.
struct HostRun {
  lab::Part part;
  Instances instances;
  std::map<int, std::shared_ptr<execute::RemoteEnd>> ends;
  execute::Outcome outcome;
  Result result;
};

void add_ends(HostRun& host, const lab::Layout& layout, std::vector<std::shared_ptr<MemoryLink>>& links) {
  host.instances.resize(host.part.phase.blocks.size());
  for (const lab::PartEnd& end : host.part.ends) {
    const lab::Cut& cut = layout.cuts[static_cast<std::size_t>(end.cut)];
    const auto& link = links[static_cast<std::size_t>(end.cut)];
    const std::string& name = host.part.phase.blocks[static_cast<std::size_t>(end.block)].name;
    lab::MadeEnd made;
    if (end.sends)
      made = cut.message ? make_record_outlet(name, cut, std::make_unique<MemoryOutlet>(link))
                         : make_sample_outlet(name, cut, std::make_unique<MemoryOutlet>(link));
    else
      made = cut.message ? make_record_inlet(name, cut, host.part.facts.period, std::make_unique<MemoryInlet>(link))
                         : make_sample_inlet(name, cut, std::make_unique<MemoryInlet>(link));
    host.instances[static_cast<std::size_t>(end.block)] = std::move(made.instance);
    host.ends[end.block] = made.end;
  }
}

void merge(Result& all, Result&& one) {
  all.streams.merge(one.streams);
  all.records.merge(one.records);
  all.changes.merge(one.changes);
  all.log.insert(all.log.end(), one.log.begin(), one.log.end());
  if (one.outcome.status != execute::Outcome::Status::complete) all.outcome = one.outcome;
}

}  // namespace

tl::expected<Result, Problems> Bench::run_on_hosts(const Cut& cut) {
  auto log_mutex = std::make_shared<std::mutex>();
  auto said = std::make_shared<std::vector<std::pair<std::string, std::string>>>();
  auto services = std::make_shared<HostServices>();
  services->log = [said, log_mutex](const std::string& block, int, const std::string& text) {
    const std::lock_guard lock(*log_mutex);
    said->emplace_back(block, text);
  };
  auto whole = plan::instantiate(phase, test_registry(), services);
  if (!whole) FAIL(to_string(whole.error()));
  const auto facts = plan::establish_facts(phase, *whole);
  if (!facts) FAIL(to_string(facts.error()));
  plan::PlanOptions wanted;
  wanted.chunk = cut.chunk;
  wanted.threads = cut.threads;
  const auto layout = lab::lay_out(phase, *facts, wanted);
  if (!layout) return tl::unexpected(layout.error());

  std::vector<std::shared_ptr<MemoryLink>> links;
  for (std::size_t i = 0; i < layout->cuts.size(); ++i) links.push_back(std::make_shared<MemoryLink>());
  std::vector<HostRun> hosts;
  for (const std::string& name : layout->hosts) {
    HostRun host;
    host.part = lab::part_of(phase, *facts, *layout, name, wanted);
    add_ends(host, *layout, links);
    for (std::size_t i = 0; i < host.part.phase.blocks.size(); ++i)
      if (!host.instances[i])
        host.instances[i] = std::move((*whole)[static_cast<std::size_t>(phase.block_index(host.part.phase.blocks[i].name))]);
    hosts.push_back(std::move(host));
  }

  std::atomic<bool> stop{false};
  std::vector<std::thread> threads;
  for (HostRun& host : hosts)
    threads.emplace_back([&] {
      const auto plan = plan::make_plan(host.part.phase, host.part.facts, host.part.options);
      if (!plan) {
        host.result.outcome.status = execute::Outcome::Status::partial;
        host.result.outcome.reason = to_string(plan.error());
        stop = true;
        return;
      }
      for (const auto& recorded : host.part.phase.recorded) {
        const graph::Block& block = host.part.phase.blocks[static_cast<std::size_t>(recorded.port.block)];
        host.result.streams[block.name + "." + block.type->port_at(BF_STREAM, BF_OUT, recorded.port.port).name].resize(
            host.part.facts.blocks[static_cast<std::size_t>(recorded.port.block)]
                .outputs[static_cast<std::size_t>(recorded.port.port)]
                .channels);
      }
      Collector sink(host.part.phase, on_samples, host.result);
      execute::Options chosen = options;
      chosen.first_chunk = 0;
      chosen.call_limit = cut.call_limit;
      chosen.stop = &stop;
      chosen.least_end = layout->end;
      for (const auto& [block, end] : host.ends) chosen.remote_ends[block] = end.get();
      std::vector<execute::InitialRecord> first;
      for (const execute::InitialRecord& record : initial) {
        const int local = host.part.phase.block_index(phase.blocks[static_cast<std::size_t>(record.to.block)].name);
        if (local >= 0) first.push_back({{local, record.to.port}, record.record});
      }
      host.result.outcome = execute::execute(host.part.phase, host.part.facts, *plan, host.instances, first, sink, chosen);
      if (host.result.outcome.status != execute::Outcome::Status::complete) stop = true;
    });
  for (std::thread& thread : threads) thread.join();
  Result all;
  for (HostRun& host : hosts) merge(all, std::move(host.result));
  all.log = *said;
  return all;
}

}  // namespace bodeflow::test
