// How a record that a block sends gets to those who take it.
#include <fmt/format.h>

#include <bodeflow/record.hpp>
#include <exception>
#include <utility>

#include "execute/run.hpp"

namespace bodeflow::execute {
namespace {

const std::string& output_name(const BlockRun& block, std::size_t port) {
  return block.instance->type().port_at(BF_MESSAGE, BF_OUT, static_cast<int>(port)).name;
}

std::string input_name(const Run& run, const Route& route) {
  const graph::Block& to = run.phase->blocks[static_cast<std::size_t>(route.to)];
  return to.name + "." +
         (route.port == graph::kParameterPort ? "parameters" : to.type->port_at(BF_MESSAGE, BF_IN, route.port).name);
}

/// "" or what is wrong with what a block sends.
std::string fault_of(const BlockRun& block, std::uint32_t port, const bf_record* record, std::uint64_t offset) {
  if (port >= block.routes.size()) return fmt::format("sent a record on message output {}: it has {}", port, block.routes.size());
  const std::string& name = output_name(block, port);
  if (record == nullptr || record->bytes == nullptr) return fmt::format("sent no record on '{}': the pointer is null", name);
  if (offset > static_cast<std::uint64_t>(block.count))
    return fmt::format("sent a record on '{}' at offset {} of a call with {} firings", name, offset, block.count);
  const auto view = RecordView::check({record->bytes, static_cast<std::size_t>(record->size)});
  if (!view) return fmt::format("sent a broken record on '{}': {}", name, view.error().text);
  const std::string& described = block.sends[port];
  if (!described.empty() && view->type() != described)
    return fmt::format("sent a record of type '{}' on '{}', described as '{}'", view->type(), name, described);
  for (const Route& route : block.routes[port])
    if (!route.type.empty() && view->type() != route.type)
      return fmt::format("sent a record of type '{}' on '{}' to '{}', which takes '{}'", view->type(), name,
                         input_name(*block.run, route), route.type);
  return "";
}

void send(BlockRun& block, Route& route, const SharedRecord& record, const Time& effect, double made_s) {
  BlockRun& to = block.run->block(route.to);
  Entry entry;
  entry.time = later(effect, route.latency);
  entry.due = to.has_streams() ? first_firing(entry.time, to.rate) : 0;
  entry.edge = route.edge;
  entry.sequence = route.sequence++;
  entry.port = route.port;
  entry.record = record;
  entry.made_s = made_s;
  if (route.remote)
    to.inbox.send(std::move(entry));
  else
    to.inbox.add(std::move(entry));
}

void emit_checked(BlockRun& block, std::uint32_t port, const bf_record* sent, std::uint64_t offset) {
  const SharedRecord record = SharedRecord::adopt(sent);
  Run& run = *block.run;
  if (run.control.abandoned() || block.fault) return;
  block.fault_text = fault_of(block, port, sent, offset);
  if (!block.fault_text.empty()) {
    block.fault = true;
    return;
  }
  const Time made = block.has_streams() ? time_of(block.position + static_cast<std::int64_t>(offset), block.rate) : block.now;
  const graph::End from{block.index, static_cast<int>(port)};
  if (auto kept = run.sink->record(from, record, seconds(made)); !kept) run.control.fail(-1, kept.error());
  for (Route& route : block.routes[port]) send(block, route, record, made, seconds(made));
}

}  // namespace

void emit(bf_process* process, std::uint32_t port, bf_record* record, std::uint64_t offset) {
  auto& block = *static_cast<BlockRun*>(process->context);
  try {
    emit_checked(block, port, record, offset);
  } catch (const std::exception& e) {
    block.run->control.fail(block.index, e.what());
  }
}

std::string forward(BlockRun& block, std::uint32_t port, const SharedRecord& record, const Time& effect, double made_s) {
  std::string fault = fault_of(block, port, record.c(), 0);
  if (!fault.empty()) return fault;
  for (Route& route : block.routes[port]) send(block, route, record, effect, made_s);
  return {};
}

}  // namespace bodeflow::execute
