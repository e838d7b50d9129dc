#include "lab/part_run.hpp"

#include <fmt/format.h>

#include "lab/channel.hpp"
#include "phases/limits.hpp"

namespace bodeflow::lab {
namespace {

/// What may be under way on a connection: a few chunks of it, at least this.
constexpr std::uint64_t kLeastQueue = std::uint64_t{4} << 20;

/// How many tolerances a connection may take to be made: processes that prove who they are take seconds on a busy machine.
constexpr int kConnects = 3;

std::uint64_t queue_bytes(const Cut& cut, const Rate& period, std::int64_t periods) {
  if (cut.message || period.num == 0) return std::uint64_t{80} << 20;
  const double samples = cut.facts.rate.hz() * period.hz() * static_cast<double>(periods);
  return std::max(kLeastQueue, static_cast<std::uint64_t>(4.0 * samples * cut.facts.channels * 16.0));
}

}  // namespace

tl::expected<std::unique_ptr<PartPhase>, Problems> PartPhase::make(const graph::Phase& phase, const std::string& host,
                                                                   Registry& registry, const phases::Services& services) {
  auto part = std::make_unique<PartPhase>();
  part->whole_ = phase;
  part->host_ = host;
  graph::Phase mine;
  mine.place = phase.place;
  for (const graph::Block& block : phase.blocks)
    if (block.host == host) mine.blocks.push_back(block);
  auto made = plan::instantiate(mine, registry, services.host());
  if (!made) return tl::unexpected(made.error());
  for (std::size_t i = 0; i < made->size(); ++i) part->made_[mine.blocks[i].name] = std::move((*made)[i]);
  return part;
}

tl::expected<Resolution, std::string> PartPhase::resolve(const std::string& block, const std::vector<StreamFacts>& inputs) {
  const auto instance = made_.find(block);
  if (instance == made_.end()) return tl::unexpected(fmt::format("block '{}' is not on host '{}'", block, host_));
  return instance->second->resolve(inputs);
}

tl::expected<void, Problems> PartPhase::prepare(const plan::Facts& facts, const plan::PlanOptions& options,
                                                const phases::Services& services) {
  auto layout = lay_out(whole_, facts, options);
  if (!layout) return tl::unexpected(layout.error());
  layout_ = std::move(*layout);
  part_ = part_of(whole_, facts, layout_, host_, options);
  auto plan = plan::make_plan(part_.phase, part_.facts, part_.options);
  if (!plan) return tl::unexpected(plan.error());
  plan_ = std::move(*plan);
  instances_.resize(part_.phase.blocks.size());
  for (std::size_t i = 0; i < part_.phase.blocks.size(); ++i) {
    const graph::Block& block = part_.phase.blocks[i];
    const auto made = made_.find(block.name);
    if (made == made_.end()) continue;
    instances_[i] = std::move(made->second);
    auto said = instances_[i]->advise(part_.facts.blocks[i].inputs, part_.facts.blocks[i].outputs);
    if (!said) return tl::unexpected(Problems{{block.place, fmt::format("block '{}': {}", block.name, said.error())}});
    for (const AdviceText& text : *said)
      if (text.level >= BF_LOG_WARNING) services.host()->log(block.name, text.level, text.text);
  }
  return {};
}

transport::Edge PartPhase::edge(const PartEnd& end, const LinksName& links, int repeat) const {
  const Cut& cut = layout_.cuts[static_cast<std::size_t>(end.cut)];
  return edge_of(links, whole_.name, repeat, static_cast<std::size_t>(end.cut), whole_.run.tolerance_s,
                 queue_bytes(cut, part_.facts.period, layout_.periods));
}

tl::expected<NewLink, std::string> PartPhase::new_link(const PartEnd& end,
                                                       const std::shared_ptr<transport::Participant>& participant,
                                                       const transport::Edge& edge, const transport::GoOn& go_on) const {
  const auto failed = [&](const transport::Failure& failure) {
    return tl::unexpected(text_of(layout_.cuts[static_cast<std::size_t>(end.cut)], failure));
  };
  NewLink link;
  if (end.sends) {
    auto outlet = transport::open_outlet(participant, edge);
    if (!outlet) return failed(outlet.error());
    auto connected = (*outlet)->connect(go_on);
    for (int more = 1; more < kConnects && !connected && connected.error().kind == transport::Failure::Kind::tolerance; ++more)
      connected = (*outlet)->connect(go_on);
    if (!connected) return failed(connected.error());
    link.outlet = std::move(*outlet);
  } else {
    auto inlet = transport::open_inlet(participant, edge);
    if (!inlet) return failed(inlet.error());
    link.inlet = std::move(*inlet);
  }
  link.epoch = edge.epoch;
  return link;
}

tl::expected<void, std::string> PartPhase::open(const PartEnd& end, const std::shared_ptr<transport::Participant>& participant,
                                                const transport::Edge& edge, const transport::GoOn& go_on) {
  const Cut& cut = layout_.cuts[static_cast<std::size_t>(end.cut)];
  const std::string& name = part_.phase.blocks[static_cast<std::size_t>(end.block)].name;
  auto opened = new_link(end, participant, edge, go_on);
  if (!opened) return tl::unexpected(opened.error());
  Link link{cut.name, end.sends ? cut.to_host : cut.from_host, end.sends, opened->outlet.get(), opened->inlet.get(), end, {}, {}};
  MadeEnd made;
  if (end.sends)
    made = cut.message ? make_record_outlet(name, cut, std::move(opened->outlet))
                       : make_sample_outlet(name, cut, std::move(opened->outlet));
  else
    made = cut.message ? make_record_inlet(name, cut, part_.facts.period, std::move(opened->inlet))
                       : make_sample_inlet(name, cut, std::move(opened->inlet));
  link.stream = made.stream;
  if (made.stream && tell_gap_)
    made.stream->on_gap([this, connection = cut.name](const Gap& gap) { tell_gap_(connection, gap); });
  instances_[static_cast<std::size_t>(end.block)] = std::move(made.instance);
  ends_[end.block] = std::move(made.end);
  links_.push_back(std::move(link));
  return {};
}

tl::expected<void, std::string> PartPhase::connect(const std::shared_ptr<transport::Participant>& participant,
                                                   const LinksName& links, int repeat, const transport::GoOn& go_on) {
  // Readers first: a writer waits for its reader, and two hosts that wait for each other's writers would wait for good.
  for (const bool sends : {false, true})
    for (const PartEnd& end : part_.ends) {
      if (end.sends != sends) continue;
      if (auto opened = open(end, participant, edge(end, links, repeat), go_on); !opened) return opened;
    }
  return {};
}

tl::expected<void, Problems> PartPhase::begin_at(std::int64_t period) {
  layout_.end = begin_part_at(part_, layout_.end, period);
  auto plan = plan::make_plan(part_.phase, part_.facts, part_.options);
  if (!plan) return tl::unexpected(plan.error());
  plan_ = std::move(*plan);
  for (const Link& link : links_)
    if (link.stream) link.stream->begin_at(static_cast<std::uint64_t>(period * samples_of(link.end)));
  return {};
}

tl::expected<std::int64_t, std::string> PartPhase::leave(const std::string& host) {
  std::int64_t period = 0;
  for (const Link& link : links_) {
    if (!link.stream) return tl::unexpected("records go over " + link.name);
    link.stream->pause(true);
    if (link.host != host) continue;
    const auto sample = link.stream->leave();
    if (!sample) return tl::unexpected(sample.error());
    const std::int64_t samples = samples_of(link.end);
    period = std::max(period, (static_cast<std::int64_t>(*sample) + samples - 1) / samples);
  }
  return period;
}

tl::expected<void, std::string> PartPhase::rejoin(const std::string& host,
                                                  const std::shared_ptr<transport::Participant>& participant,
                                                  const LinksName& links, int repeat, const transport::GoOn& go_on) {
  for (const bool sends : {false, true})
    for (Link& link : links_) {
      if (link.host != host || link.sends != sends) continue;
      auto made = new_link(link.end, participant, edge(link.end, links, repeat), go_on);
      if (!made) return tl::unexpected(made.error());
      link.next = std::move(*made);
    }
  return {};
}

tl::expected<void, std::string> PartPhase::go_on(const std::string& host, std::int64_t period, const transport::GoOn& go_on) {
  for (Link& link : links_) {
    if (link.host == host) {
      {
        const std::lock_guard lock(links_mutex_);
        link.outlet = link.next.outlet.get();
        link.inlet = link.next.inlet.get();
      }
      const auto sample = static_cast<std::uint64_t>(period * samples_of(link.end));
      if (auto joined = link.stream->rejoin(std::move(link.next), sample, go_on); !joined)
        return tl::unexpected(text_of(layout_.cuts[static_cast<std::size_t>(link.end.cut)], joined.error()));
    }
    link.stream->pause(false);
  }
  return {};
}

execute::Outcome PartPhase::run(const std::vector<execute::InitialRecord>& initial, record::RunDirectory& directory,
                                const HostServices& services, int repeat, execute::Options options) {
  std::vector<execute::InitialRecord> mine;
  for (const execute::InitialRecord& record : initial) {
    const int block = part_.phase.block_index(whole_.blocks[static_cast<std::size_t>(record.to.block)].name);
    if (block >= 0) mine.push_back({{block, record.to.port}, record.record});
  }
  for (const auto& [block, end] : ends_) options.remote_ends[block] = end.get();
  options.least_end = layout_.end;
  const auto sink = directory.begin_phase(part_.phase, part_.facts, plan::to_json(part_.phase, part_.facts, plan_), repeat);
  if (!sink) {
    execute::Outcome refused;
    refused.status = execute::Outcome::Status::partial;
    refused.reason = sink.error();
    return refused;
  }
  const phases::LimitTeller limits(part_.phase, repeat, plan_, directory, services);
  options.violated = [&](int limit, const execute::Violation& violation) { limits.violated(limit, violation); };
  execute::Outcome outcome = execute::execute(part_.phase, part_.facts, plan_, instances_, mine, **sink, options);
  limits.ended(outcome);
  if (const auto ended = directory.end_phase(outcome); !ended && outcome.status == execute::Outcome::Status::complete) {
    outcome.status = execute::Outcome::Status::partial;
    outcome.reason = ended.error();
  }
  return outcome;
}

void PartPhase::drain(const transport::GoOn& go_on) {
  for (const Link& link : links_)
    if (link.sends) (void)link.outlet->drain(go_on);
}

nlohmann::json PartPhase::links() const {
  nlohmann::json list = nlohmann::json::array();
  const std::lock_guard lock(links_mutex_);
  for (const Link& link : links_) {
    const transport::EdgeState state = link.sends ? link.outlet->state() : link.inlet->state();
    list.push_back({{"connection", link.name},
                    {"other", link.host},
                    {"sends", link.sends},
                    {"matched", state.matched},
                    {"messages", state.messages},
                    {"samples", state.samples},
                    {"bytes", state.bytes},
                    {"queued_bytes", state.queued_bytes},
                    {"gaps", state.gaps},
                    {"refused", state.refused},
                    {"reconnects", state.reconnects},
                    {"waited_s", state.waited_s},
                    {"stalled_s", state.stalled_s},
                    {"latency_p50_s", state.latency_p50_s},
                    {"latency_p99_s", state.latency_p99_s}});
  }
  return list;
}

std::vector<std::pair<std::string, std::string>> PartPhase::outputs() const {
  std::vector<std::pair<std::string, std::string>> names;
  for (const graph::Block& block : whole_.blocks) {
    if (block.host != host_) continue;
    for (int port = 0; port < block.type->count(BF_MESSAGE, BF_OUT); ++port)
      names.emplace_back(block.name, block.type->port_at(BF_MESSAGE, BF_OUT, port).name);
  }
  return names;
}

void PartPhase::abandon() {
  for (auto& instance : instances_) (void)instance.release();
}

}  // namespace bodeflow::lab
