#include "plan/buffers.hpp"

#include <algorithm>

namespace bodeflow::plan {
namespace {

constexpr std::uint64_t kAlignment = 64;

std::size_t values_per_sample(const Buffer& buffer) { return buffer.element == BF_C64 ? 2 : 1; }

/// Whether the newest samples of `history`, that of a group of readers, are what a reader with fewer wants to see.
bool agrees(const Buffer& buffer, std::uint64_t history, const std::vector<double>& values, const Flow& reader) {
  if (values.empty() && reader.initial.empty()) return true;  // zeros, both, however many
  const std::size_t width = values_per_sample(buffer);
  const auto value = [](const std::vector<double>& from, std::size_t index) { return from.empty() ? 0.0 : from[index]; };
  for (std::size_t channel = 0; channel < buffer.channels; ++channel) {
    const std::size_t theirs = (channel * history + (history - reader.delay)) * width, mine = channel * reader.delay * width;
    for (std::size_t i = 0; i < reader.delay * width; ++i) {
      if (value(values, theirs + i) != value(reader.initial, mine + i)) return false;
    }
  }
  return true;
}

/// Readers that see the same past.
struct Group {
  std::vector<graph::End> readers;
  std::uint64_t history = 0;
  std::vector<double> initial;
};

std::vector<Group> group_readers(const Facts& facts, const Buffer& buffer, std::vector<graph::End> readers) {
  const auto flow = [&](const graph::End& end) -> const Flow& { return facts.blocks[end.block].input_flows[end.port]; };
  std::stable_sort(readers.begin(), readers.end(),
                   [&](const graph::End& a, const graph::End& b) { return flow(a).delay > flow(b).delay; });
  std::vector<Group> groups;
  for (const graph::End& reader : readers) {
    const auto fits = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return agrees(buffer, group.history, group.initial, flow(reader));
    });
    if (fits != groups.end()) {
      fits->readers.push_back(reader);
    } else {
      groups.push_back({{reader}, flow(reader).delay, flow(reader).initial});
    }
  }
  return groups;
}

class Assignment {
 public:
  Assignment(const graph::Phase& phase, const Facts& facts, std::int64_t repetitions)
      : phase_(phase), facts_(facts), repetitions_(repetitions) {
    for (const Facts::Block& block : facts.blocks) {
      made_.inputs.emplace_back(block.inputs.size());
      made_.outputs.emplace_back(block.outputs.size());
    }
  }

  Buffers run() {
    std::vector<std::vector<std::vector<graph::End>>> readers;
    for (const Facts::Block& block : facts_.blocks) readers.emplace_back(block.outputs.size());
    for (const graph::StreamEdge& edge : phase_.streams) readers[edge.from.block][edge.from.port].push_back(edge.to);

    struct Later {
      graph::End output;
      int from;
      Group group;
    };
    std::vector<Later> later;
    for (int block = 0; block < static_cast<int>(facts_.blocks.size()); ++block) {
      for (int port = 0; port < static_cast<int>(readers[block].size()); ++port) {
        std::vector<Group> groups = group_readers(facts_, empty(block, port), readers[block][port]);
        const int index = add({block, port}, groups.empty() ? Group{} : groups.front());
        made_.outputs[block][port].buffer = index;
        for (std::size_t i = 1; i < groups.size(); ++i) later.push_back({{block, port}, index, std::move(groups[i])});
      }
    }
    for (const Later& item : later) {
      const int index = add(item.output, item.group);
      made_.copies.push_back({item.output.block, item.output.port, item.from, index, made_.readers[index]});
    }
    return std::move(made_);
  }

 private:
  Buffer empty(int block, int port) const {
    const Facts::Block& facts = facts_.blocks[block];
    Buffer buffer;
    buffer.element = facts.outputs[port].element;
    buffer.channels = facts.outputs[port].channels;
    buffer.capacity = static_cast<std::uint64_t>(repetitions_ * facts.repetitions) * facts.output_flows[port].samples;
    return buffer;
  }

  int add(const graph::End& output, const Group& group) {
    const int index = static_cast<int>(made_.all.size());
    Buffer buffer = empty(output.block, output.port);
    buffer.history = group.history;
    buffer.bytes = slot_bytes(buffer);
    std::vector<int> readers;
    for (const graph::End& reader : group.readers) {
      made_.inputs[reader.block][reader.port] = {index, facts_.blocks[reader.block].input_flows[reader.port].delay};
      readers.push_back(reader.block);
    }
    std::sort(readers.begin(), readers.end());
    readers.erase(std::unique(readers.begin(), readers.end()), readers.end());
    made_.all.push_back(buffer);
    made_.initial.push_back(group.initial);
    made_.writer.push_back(output.block);
    made_.readers.push_back(std::move(readers));
    return index;
  }

  const graph::Phase& phase_;
  const Facts& facts_;
  std::int64_t repetitions_;
  Buffers made_;
};

}  // namespace

std::uint64_t slot_bytes(const Buffer& buffer) {
  const std::uint64_t sample = buffer.element == BF_C64 ? 16 : 8;
  const std::uint64_t channel = (buffer.history + buffer.capacity) * sample;
  return buffer.channels * ((channel + kAlignment - 1) / kAlignment * kAlignment);
}

Buffers assign_buffers(const graph::Phase& phase, const Facts& facts, std::int64_t repetitions) {
  return Assignment(phase, facts, repetitions).run();
}

}  // namespace bodeflow::plan
