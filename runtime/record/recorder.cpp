#include "record/recorder.hpp"

#include <algorithm>
#include <chrono>

#include "record/files.hpp"
#include "record/queues.hpp"

namespace bodeflow::record {
namespace {

/// Twice as often as promised: a flush takes time too.
constexpr std::chrono::milliseconds kFlushInterval{500};
/// A run that keeps time is not made to call: the writer looks so often by itself.
constexpr std::chrono::milliseconds kPollInterval{20};
/// Samples that wait, of all streams together and of one.
constexpr std::size_t kWaitingBytes = std::size_t{256} << 20U;
constexpr std::size_t kStreamLeast = std::size_t{2} << 20U, kStreamMost = std::size_t{8} << 20U;

const char* cause_word(execute::Cause cause) {
  switch (cause) {
    case execute::Cause::schedule:
      return "schedule";
    case execute::Cause::record:
      return "record";
    default:
      return "live";
  }
}

}  // namespace

Recorder::Recorder(DataWriter& data, Event event) : data_(data), event_(std::move(event)) {}

Recorder::~Recorder() { (void)finish(); }

void Recorder::name_parameters(const graph::Phase& phase) {
  for (const auto& block : phase.blocks) {
    BlockNames names;
    names.name = block.name;
    for (const auto& parameter : block.type->parameters) names.parameters.push_back(parameter.name);
    names.first_output = static_cast<int>(records_.size());
    const int outputs = block.type->count(BF_MESSAGE, BF_OUT);
    for (int port = 0; port < outputs; ++port)
      records_.push_back(std::make_unique<RecordQueue>(
          Origin{phase.name, repeat_, block.name, block.type->port_at(BF_MESSAGE, BF_OUT, port).name}));
    blocks_.push_back(std::move(names));
  }
}

tl::expected<std::unique_ptr<Recorder>, std::string> Recorder::begin(const graph::Phase& phase, const plan::Facts& facts,
                                                                     int repeat, DataWriter& data, Event event) {
  std::unique_ptr<Recorder> recorder(new Recorder(data, std::move(event)));
  Recorder& r = *recorder;
  r.finished_ = true;  // until the thread runs there is nothing to finish
  r.phase_ = phase.name;
  r.repeat_ = repeat;
  r.name_parameters(phase);

  std::vector<StreamTarget> targets;
  for (auto recorded = phase.recorded.begin(); recorded != phase.recorded.end(); ++recorded) {
    const auto [port, kind] = *recorded;
    const bool again = std::any_of(phase.recorded.begin(), recorded, [&, at = port](const auto& earlier) {
      return earlier.port == at && earlier.kind == BF_STREAM;
    });
    const bool stream = kind == BF_STREAM && !again;
    r.stream_of_.push_back(stream ? static_cast<int>(targets.size()) : -1);
    if (!stream) continue;
    const auto block = static_cast<std::size_t>(port.block);
    const auto& type = *phase.blocks[block].type;
    targets.push_back({{phase.name, repeat, phase.blocks[block].name, type.port_at(BF_STREAM, BF_OUT, port.port).name},
                       facts.blocks[block].outputs[static_cast<std::size_t>(port.port)]});
  }
  const std::size_t limit = std::clamp(kWaitingBytes / std::max<std::size_t>(1, targets.size()), kStreamLeast, kStreamMost);
  r.polls_ = phase.run.clock != graph::Clock::simulated;
  for (const auto& target : targets)
    r.streams_.push_back(std::make_unique<StreamQueue>(target.origin, target.facts, limit, r.polls_));
  std::vector<Origin> ports;
  for (const auto& queue : r.records_) ports.push_back(queue->origin());

  if (auto begun = data.begin(targets, ports); !begun) return tl::unexpected(begun.error());
  r.finished_ = false;
  r.thread_ = std::thread([&r] { r.run(); });
  return recorder;
}

tl::expected<void, std::string> Recorder::refused() const {
  if (!refusing_) return {};
  const std::lock_guard lock(mutex_);
  return tl::unexpected(error_.empty() ? "the recording of this phase has ended" : error_);
}

tl::expected<void, std::string> Recorder::samples(int recorded, const void* const* channels, std::uint64_t count) {
  const int stream = stream_of_[static_cast<std::size_t>(recorded)];
  if (stream >= 0) streams_[static_cast<std::size_t>(stream)]->put(channels, count, refusing_, [&] { wake(); });
  return refused();
}

tl::expected<void, std::string> Recorder::record(graph::End from, const SharedRecord& record, double time_s) {
  const int output = blocks_[static_cast<std::size_t>(from.block)].first_output + from.port;
  if (records_[static_cast<std::size_t>(output)]->put(record, time_s, refusing_)) wake();
  return refused();
}

void Recorder::changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, execute::Cause cause) {
  const std::lock_guard lock(changes_mutex_);
  changes_.push_back({utc_now(), block, parameter, value, position, cause});
}

void Recorder::wake() {
  {
    const std::lock_guard lock(mutex_);
    work_ = true;
  }
  wake_.notify_one();
}

void Recorder::failed(const std::string& error) {
  {
    const std::lock_guard lock(mutex_);
    if (error_.empty()) error_ = error;
    refusing_ = true;
  }
  for (auto& stream : streams_) stream->wake();
  for (auto& port : records_) port->wake();
}

void Recorder::run() {
  try {
    write_until_stopped();
  } catch (const std::exception& error) {
    failed(std::string("can't record: ") + error.what());
  }
}

void Recorder::write_until_stopped() {
  auto next_flush = std::chrono::steady_clock::now() + kFlushInterval;
  while (true) {
    bool stopping = false;
    {
      std::unique_lock lock(mutex_);
      const auto until = polls_ ? std::min(next_flush, std::chrono::steady_clock::now() + kPollInterval) : next_flush;
      wake_.wait_until(lock, until, [&] { return work_ || stop_; });
      work_ = false;
      stopping = stop_;
    }
    const bool flush = stopping || std::chrono::steady_clock::now() >= next_flush;
    drain_changes();
    drain(flush);
    if (flush && !refusing_) {
      if (const auto flushed = data_.flush(); !flushed) failed(flushed.error());
    }
    if (flush) next_flush = std::chrono::steady_clock::now() + kFlushInterval;
    if (stopping) return;
  }
}

void Recorder::drain(bool all) {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    for (int piece = 0; piece < 3; ++piece) {
      const auto rows = streams_[i]->take(all);
      if (rows.empty() || refusing_) break;
      if (const auto done = data_.append_samples(i, rows.data(), streams_[i]->rows_in(rows)); !done)
        failed(done.error());
      else
        streams_[i]->written(rows);
    }
  }
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const auto records = records_[i]->take();
    if (records.empty() || refusing_) continue;
    if (const auto done = data_.append_records(i, records); !done)
      failed(done.error());
    else
      records_[i]->written(records);
  }
}

void Recorder::drain_changes() {
  std::vector<Change> changes;
  {
    const std::lock_guard lock(changes_mutex_);
    changes.swap(changes_);
  }
  for (const auto& change : changes) {
    const BlockNames& block = blocks_[static_cast<std::size_t>(change.block)];
    nlohmann::ordered_json details;
    details["time"] = change.time;
    if (!phase_.empty()) details["phase"] = phase_;
    if (repeat_ > 0) details["repeat"] = repeat_;
    details["block"] = block.name;
    details["parameter"] = block.parameters[static_cast<std::size_t>(change.parameter)];
    details["value"] = to_json(change.value);
    details["position"] = change.position;
    details["by"] = cause_word(change.cause);
    event_("parameter changed", std::move(details));
  }
}

tl::expected<void, std::string> Recorder::finish() {
  if (!finished_) {
    finished_ = true;
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
    const auto ended = data_.end(error_.empty());
    failed(ended ? "" : ended.error());
  }
  const std::lock_guard lock(mutex_);
  if (!error_.empty()) return tl::unexpected(error_);
  return {};
}

void Recorder::let_go() {
  for (auto& stream : streams_) stream->close();
  for (auto& port : records_) port->close();
}

std::vector<std::pair<std::string, std::string>> Recorder::hashes() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& stream : streams_) all.emplace_back(key_of(stream->origin()), stream->hash());
  for (const auto& port : records_) all.emplace_back(key_of(port->origin()), port->hash());
  return all;
}

std::vector<Recorder::Last> Recorder::last_records() const {
  std::vector<Last> all;
  for (const auto& port : records_)
    if (SharedRecord record = port->last()) all.push_back({port->origin().block, port->origin().port, std::move(record)});
  return all;
}

nlohmann::ordered_json to_json(const ParameterValue& value) {
  using nlohmann::ordered_json;
  const bool scalar = value.type <= BF_FILE;
  if (scalar && value.rows == 0) return nullptr;
  const auto list_of = [](const auto& values) {
    ordered_json list = ordered_json::array();
    for (const auto& x : values) list.push_back(x);
    return list;
  };
  switch (value.type) {
    case BF_BOOL:
      return value.integer != 0;
    case BF_INTEGER:
      return value.integer;
    case BF_NUMBER:
      return value.numbers.at(0);
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      return value.strings.at(0);
    case BF_INTEGERS:
      return list_of(value.integers);
    case BF_STRINGS:
      return list_of(value.strings);
    case BF_COMPLEX_LIST:
    case BF_MATRIX: {
      const std::size_t columns = value.type == BF_MATRIX ? std::max(1U, value.columns) : 2;
      ordered_json rows = ordered_json::array();
      for (std::size_t i = 0; i + columns <= value.numbers.size(); i += columns)
        rows.push_back(std::vector<double>(value.numbers.begin() + static_cast<std::ptrdiff_t>(i),
                                           value.numbers.begin() + static_cast<std::ptrdiff_t>(i + columns)));
      return rows;
    }
    default:
      return list_of(value.numbers);
  }
}

}  // namespace bodeflow::record
