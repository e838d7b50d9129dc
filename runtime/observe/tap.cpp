#include "observe/tap.hpp"

namespace bodeflow::observe {

Tap::Tap(const graph::Phase& phase, execute::Sink& sink) : sink_(sink), blocks_(phase.blocks.size()) {
  for (std::size_t b = 0; b < phase.blocks.size(); ++b) {
    const BlockDescription& type = *phase.blocks[b].type;
    blocks_[b].outputs.resize(static_cast<std::size_t>(type.count(BF_MESSAGE, BF_OUT)));
    blocks_[b].parameters.resize(type.parameters.size());
  }
}

tl::expected<void, std::string> Tap::samples(int recorded, const void* const* channels, std::uint64_t count) {
  return sink_.samples(recorded, channels, count);
}

tl::expected<void, std::string> Tap::record(graph::End from, const SharedRecord& record, double time_s) {
  Output& output = blocks_[static_cast<std::size_t>(from.block)].outputs[static_cast<std::size_t>(from.port)];
  output.last.put(std::make_unique<Sent>(Sent{record, time_s, ++output.count}));
  return sink_.record(from, record, time_s);
}

void Tap::changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, execute::Cause cause) {
  blocks_[static_cast<std::size_t>(block)].parameters[static_cast<std::size_t>(parameter)].put(
      std::make_unique<Taken>(Taken{value}));
  sink_.changed(block, parameter, value, position, cause);
}

std::unique_ptr<Sent> Tap::take_record(graph::End from) {
  return blocks_[static_cast<std::size_t>(from.block)].outputs[static_cast<std::size_t>(from.port)].last.take();
}

std::unique_ptr<Taken> Tap::take_value(int block, int parameter) {
  return blocks_[static_cast<std::size_t>(block)].parameters[static_cast<std::size_t>(parameter)].take();
}

}  // namespace bodeflow::observe
