#include "plan/memory.hpp"

#include <algorithm>

namespace bodeflow::plan {
namespace {

/// Chunks that a ring between two threads holds.
constexpr std::uint32_t kRingSlots = 4;

class Placement {
 public:
  Placement(const graph::Phase& phase, Buffers& buffers, const std::vector<graph::End>& kept, Plan& plan)
      : phase_(phase), buffers_(buffers), plan_(plan), lives_(buffers.all.size()), shares_(buffers.all.size(), -1) {
    kept_.assign(buffers.all.size(), false);
    for (const graph::End& end : kept) kept_[buffers.outputs[end.block][end.port].buffer] = true;
  }

  void run() {
    make_rings();
    for (int partition = 0; partition < static_cast<int>(plan_.partitions.size()); ++partition) {
      steps_ = static_cast<int>(plan_.partitions[partition].steps.size());
      find_lifetimes(partition);
      find_shared(partition);
      lay_out_arena(partition);
    }
  }

 private:
  /// Buffers that other partitions read become rings.
  void make_rings() {
    plan_.readers.resize(buffers_.all.size());
    for (std::size_t index = 0; index < buffers_.all.size(); ++index) {
      Buffer& buffer = buffers_.all[index];
      buffer.partition = plan_.partition_of[buffers_.writer[index]];
      std::vector<int>& others = plan_.readers[index];
      for (const int reader : buffers_.readers[index]) {
        if (plan_.partition_of[reader] != buffer.partition) others.push_back(plan_.partition_of[reader]);
      }
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
      buffer.slots = others.empty() ? 1 : kRingSlots;
      buffer.bytes = buffer.slots * slot_bytes(buffer);
    }
  }

  bool lives_always(int index) const { return buffers_.all[index].history > 0 || buffers_.all[index].slots > 1; }

  /// Blocks that a step calls.
  static std::vector<int> blocks_of(const Step& step) {
    std::vector<int> blocks;
    if (step.kind == Step::Kind::call) blocks.push_back(step.block);
    if (step.kind == Step::Kind::cluster) {
      for (const Firing& firing : step.schedule) blocks.push_back(firing.block);
      std::sort(blocks.begin(), blocks.end());
      blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    }
    return blocks;
  }

  void touch(int index, int step, int partition) {
    if (index < 0 || buffers_.all[index].partition != partition) return;
    Lifetime& life = lives_[index];
    if (life.bytes == 0) life.first = step;
    life.bytes = buffers_.all[index].bytes;
    life.last = step;
  }

  void find_lifetimes(int partition) {
    const std::vector<Step>& steps = plan_.partitions[partition].steps;
    for (int i = 0; i < steps_; ++i) {
      for (const int block : blocks_of(steps[i])) {
        for (const Use& use : buffers_.inputs[block]) touch(use.buffer, i, partition);
        for (const Use& use : buffers_.outputs[block]) touch(use.buffer, i, partition);
      }
      for (const Firing& firing : steps[i].schedule) touch(firing.to_buffer, i, partition);
      touch(steps[i].from_buffer, i, partition);
      touch(steps[i].to_buffer, i, partition);
    }
    for (std::size_t index = 0; index < lives_.size(); ++index) {
      if (buffers_.all[index].partition != partition) continue;
      if (lives_always(static_cast<int>(index))) lives_[index] = {buffers_.all[index].bytes, -1, steps_};
      if (kept_[index]) lives_[index].last = steps_;
    }
  }

  /// Outputs that take over the memory of an input that ends there.
  void find_shared(int partition) {
    const std::vector<Step>& steps = plan_.partitions[partition].steps;
    for (int i = 0; i < steps_; ++i) {
      if (steps[i].kind != Step::Kind::call || !phase_.blocks[steps[i].block].type->in_place) continue;
      const auto &inputs = buffers_.inputs[steps[i].block], &outputs = buffers_.outputs[steps[i].block];
      for (std::size_t port = 0; port < std::min(inputs.size(), outputs.size()); ++port) {
        const int input = inputs[port].buffer, output = outputs[port].buffer;
        if (input < 0 || !may_share(input, output, i, partition)) continue;
        const auto uses = std::count_if(inputs.begin(), inputs.end(), [&](const Use& use) { return use.buffer == input; });
        if (uses == 1) shares_[output] = input;
      }
    }
  }

  bool may_share(int input, int output, int step, int partition) const {
    const Buffer &a = buffers_.all[input], &b = buffers_.all[output];
    return a.partition == partition && lives_[input].last == step && !lives_always(input) && !lives_always(output) &&
           a.element == b.element && a.channels == b.channels && a.capacity == b.capacity;
  }

  void lay_out_arena(int partition) {
    std::vector<int> owners, owner_of(lives_.size(), -1);
    std::vector<Lifetime> lifetimes;
    for (std::size_t index = 0; index < lives_.size(); ++index) {
      if (buffers_.all[index].partition != partition) continue;
      int root = static_cast<int>(index);
      while (shares_[root] >= 0) root = shares_[root];
      if (owner_of[root] < 0) {
        owner_of[root] = static_cast<int>(lifetimes.size());
        lifetimes.push_back(lives_[root]);
      }
      owner_of[index] = owner_of[root];
      lifetimes[owner_of[root]].last = std::max(lifetimes[owner_of[root]].last, lives_[index].last);
    }
    const Layout layout = lay_out(lifetimes);
    for (std::size_t index = 0; index < lives_.size(); ++index) {
      if (owner_of[index] >= 0) buffers_.all[index].arena_offset = layout.offsets[owner_of[index]];
    }
    plan_.partitions[partition].arena_bytes = layout.bytes;
  }

  const graph::Phase& phase_;
  Buffers& buffers_;
  Plan& plan_;
  std::vector<Lifetime> lives_;
  std::vector<int> shares_;  ///< per buffer: whose memory it takes over, or -1
  std::vector<bool> kept_;
  int steps_ = 0;
};

}  // namespace

void place_buffers(const graph::Phase& phase, Buffers& buffers, const std::vector<graph::End>& kept, Plan& plan) {
  Placement(phase, buffers, kept, plan).run();
}

}  // namespace bodeflow::plan
