#include "plan/links.hpp"

#include "plan/exact.hpp"
#include "plan/names.hpp"

namespace bodeflow::plan {

tl::expected<std::vector<Link>, Problems> links_of(const graph::Phase& phase, const Facts& facts) {
  std::vector<Link> links;
  Problems problems;
  for (std::size_t i = 0; i < phase.streams.size(); ++i) {
    const graph::StreamEdge& edge = phase.streams[i];
    const Flow& input = facts.blocks[edge.to.block].input_flows[edge.to.port];
    Link link;
    link.from = edge.from.block;
    link.to = edge.to.block;
    link.edge = static_cast<int>(i);
    link.produced = facts.blocks[edge.from.block].output_flows[edge.from.port].samples;
    link.consumed = input.samples;
    link.delay = static_cast<std::int64_t>(input.delay);
    links.push_back(link);
  }
  for (std::size_t i = 0; i < phase.messages.size(); ++i) {
    const graph::MessageEdge& edge = phase.messages[i];
    Link link;
    link.from = edge.from.block;
    link.to = edge.to.block;
    link.message = true;
    link.edge = static_cast<int>(i);
    link.latency = edge.latency.seconds;
    if (edge.latency.samples > 0) {
      const Rate& rate = facts.blocks[edge.to.block].firing_rate;
      const auto seconds = rate.known() ? divide(Rate{edge.latency.samples, 1}, rate) : std::nullopt;
      if (!seconds) {
        problems.push_back({edge.place, "connection " + connection(phase, edge) + ": a latency in samples, but block '" +
                                            phase.blocks[edge.to.block].name + "' has no streams; give the latency in seconds"});
        continue;
      }
      link.latency = *seconds;
    }
    links.push_back(link);
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return links;
}

Place place_of(const graph::Phase& phase, const Link& link) {
  return link.message ? phase.messages[link.edge].place : phase.streams[link.edge].place;
}

std::string connection(const graph::Phase& phase, const Link& link) {
  return link.message ? connection(phase, phase.messages[link.edge]) : connection(phase, phase.streams[link.edge]);
}

}  // namespace bodeflow::plan
