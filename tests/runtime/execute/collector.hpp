#pragma once

#include <mutex>

#include "bench.hpp"

namespace bodeflow::test {

/// Keeps everything. Ports come from different threads.
class Collector final : public execute::Sink {
 public:
  Collector(const graph::Phase& phase, const OnSamples& on_samples, Result& result)
      : phase_(phase), on_samples_(on_samples), result_(result) {
    for (const auto& recorded : phase.recorded) names_.push_back(name(recorded.port, BF_STREAM));
  }

  tl::expected<void, std::string> samples(int recorded, const void* const* channels, std::uint64_t count) override {
    const std::lock_guard lock(mutex_);
    const std::string& port = names_[static_cast<std::size_t>(recorded)];
    auto& kept = result_.streams[port];
    for (std::size_t c = 0; c < kept.size(); ++c) {
      const auto* from = static_cast<const double*>(channels[c]);
      kept[c].insert(kept[c].end(), from, from + count);
    }
    return on_samples_ ? on_samples_(port) : tl::expected<void, std::string>{};
  }

  tl::expected<void, std::string> record(graph::End from, const SharedRecord& record, double time_s) override {
    const std::lock_guard lock(mutex_);
    result_.records[name(from, BF_MESSAGE)].push_back({{record.bytes(), record.bytes() + record.size()}, time_s});
    return {};
  }

  void changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, execute::Cause cause) override {
    const std::lock_guard lock(mutex_);
    const graph::Block& b = phase_.blocks[static_cast<std::size_t>(block)];
    result_.changes[b.name].push_back(
        {b.name, b.type->parameters[static_cast<std::size_t>(parameter)].name, value, position, cause});
  }

 private:
  std::string name(graph::End end, std::uint32_t kind) const {
    const graph::Block& block = phase_.blocks[static_cast<std::size_t>(end.block)];
    return block.name + "." + block.type->port_at(kind, BF_OUT, end.port).name;
  }

  const graph::Phase& phase_;
  const OnSamples& on_samples_;
  Result& result_;
  std::vector<std::string> names_;
  std::mutex mutex_;
};

}  // namespace bodeflow::test
