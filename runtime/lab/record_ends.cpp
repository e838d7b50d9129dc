// Records between hosts: each goes with its exact time, and the sender says how far it is, so that the receiver knows what can't
// come any more.
#include <fmt/format.h>

#include <cstring>
#include <deque>
#include <limits>

#include "execute/run.hpp"
#include "lab/end_base.hpp"

namespace bodeflow::lab {
namespace {

using Result = tl::expected<void, std::string>;
using execute::BlockRun;
using execute::Horizon;
using execute::Lane;
using execute::Time;

/// How far the sender is, in the header of a Kind::end message: its `position`.
enum class Stage : std::int64_t {
  streams,  ///< its streams have ended
  rested,   ///< blocks without streams have taken what was left
  finished  ///< nothing more comes
};

PortDescription message_port(std::uint32_t direction, const char* name) {
  PortDescription port;
  port.kind = BF_MESSAGE;
  port.direction = direction;
  port.name = name;
  return port;
}

tl::expected<transport::Header, std::string> head(transport::Kind kind, const Time& time) {
  constexpr __int128 kMost = std::numeric_limits<std::int64_t>::max();
  if (time.num > kMost || time.num < -kMost || time.den > kMost)
    return tl::unexpected(
        std::string("the time of a record is no fraction of two 64-bit numbers: sample rates with a simpler ratio help"));
  transport::Header header;
  header.kind = kind;
  header.position = static_cast<std::int64_t>(time.num);
  header.rate_num = static_cast<std::int64_t>(time.den);
  return header;
}

class RecordOutlet final : public End {
 public:
  RecordOutlet(const Cut& cut, std::unique_ptr<transport::Outlet> outlet) : cut_(cut), outlet_(std::move(outlet)) {}

  bool reached(BlockRun& block, const Horizon& horizon, Lane& lane) override {
    if (horizon.endless) return done(block, send_stage(Stage::streams, block, lane));
    if (!(told_ < horizon.time)) return true;
    told_ = horizon.time;
    auto header = head(transport::Kind::horizon, horizon.time);
    if (!header) return done(block, tl::unexpected(header.error()));
    return done(block, send(*header, {}, block, lane));
  }

  bool rested(BlockRun& block, Lane& lane) override { return done(block, send_stage(Stage::rested, block, lane)); }

 protected:
  Result process(BlockRun& block, bf_process& call) override {
    for (std::uint32_t i = 0; i < call.message_count; ++i) {
      auto header = head(transport::Kind::record, block.now);
      if (!header) return tl::unexpected(header.error());
      const bf_record& record = *call.messages[i].record;
      const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(record.bytes), record.size);
      if (auto sent = send(*header, {&bytes, 1}, block, execute::lane_of(block)); !sent) return sent;
    }
    return {};
  }

  Result finish(BlockRun& block) override { return send_stage(Stage::finished, block, execute::last_lane_of(block)); }

 private:
  bool done(BlockRun& block, const Result& result) {
    if (!result) block.run->control.fail(block.index, result.error());
    return result.has_value();
  }

  Result send(const transport::Header& header, std::span<const std::span<const std::byte>> parts, BlockRun& block, Lane& lane) {
    const auto sent = outlet_->send(header, parts, [&] { return execute::goes_on(block, lane); });
    return sent ? Result{} : Result(tl::unexpected(text_of(cut_, sent.error())));
  }

  Result send_stage(Stage stage, BlockRun& block, Lane& lane) {
    if (stage_ && *stage_ >= stage) return {};
    stage_ = stage;
    transport::Header header;
    header.kind = transport::Kind::end;
    header.rate_num = 1;
    header.position = static_cast<std::int64_t>(stage);
    return send(header, {}, block, lane);
  }

  Cut cut_;
  std::unique_ptr<transport::Outlet> outlet_;
  Time told_;
  std::optional<Stage> stage_;
};

class RecordInlet final : public End {
 public:
  RecordInlet(const Cut& cut, const Rate& period, std::unique_ptr<transport::Inlet> inlet)
      : cut_(cut), period_(period), inlet_(std::move(inlet)) {}

  bool silent() const override { return silent_.load(std::memory_order_acquire); }

  bool rested(BlockRun& block, Lane& lane) override {
    if (cut_.ahead) return true;
    const Result result = wait(Stage::rested, block, lane);
    if (!result) block.run->control.fail(block.index, result.error());
    return result.has_value();
  }

 protected:
  /// All records that take effect in the call's periods are here when it returns.
  Result process(BlockRun& block, bf_process& call) override {
    if (stage_) {
      call.done = 0;
      return {};
    }
    const Time end = execute::multiple_of(static_cast<std::int64_t>(call.position + call.count), period_);
    while (!stage_ && execute::later(horizon_, cut_.latency) < end)
      if (auto taken = take_next(block, execute::lane_of(block)); !taken) return taken;
    if (call.outputs[0].channel_count > 0)
      std::memset(static_cast<double*>(call.outputs[0].channels[0]) + call.outputs[0].offset, 0, call.count * sizeof(double));
    return {};
  }

  /// A connection that runs ahead does not wait for what a finish sends: its consumer has finished by then also in one process.
  Result finish(BlockRun& block) override {
    return wait(cut_.ahead ? Stage::rested : Stage::finished, block, execute::last_lane_of(block));
  }

 private:
  Result wait(Stage stage, BlockRun& block, Lane& lane) {
    while (!stage_ || *stage_ < stage)
      if (auto taken = take_next(block, lane); !taken) return taken;
    return {};
  }

  Result take_next(BlockRun& block, Lane& lane) {
    auto message = inlet_->next([&] { return execute::goes_on(block, lane); });
    if (!message) return tl::unexpected(text_of(cut_, message.error()));
    const transport::Header& header = message->header;
    const Time time{header.position, header.rate_num};
    if (header.kind == transport::Kind::end && header.position >= 0 &&
        header.position <= static_cast<std::int64_t>(Stage::finished)) {
      stage_ = static_cast<Stage>(header.position);
      silent_.store(true, std::memory_order_release);
    } else if (header.kind == transport::Kind::horizon && header.rate_num > 0) {
      horizon_ = time;
    } else if (header.kind == transport::Kind::record && header.rate_num > 0) {
      const SharedRecord record = SharedRecord::copy(message->payload.data(), message->payload.size());
      const std::string wrong = execute::forward(block, 0, record, execute::later(time, cut_.latency), execute::seconds(time));
      if (!wrong.empty()) return tl::unexpected(text_of(cut_, {{}, wrong}));
    } else {
      return tl::unexpected(text_of(cut_, {{}, "the other side sent something else than records"}));
    }
    return {};
  }

  Cut cut_;
  Rate period_;
  std::unique_ptr<transport::Inlet> inlet_;
  Time horizon_;
  std::optional<Stage> stage_;
  std::atomic<bool> silent_{false};
};

}  // namespace

const BlockDescription& record_outlet() {
  static const BlockDescription type = [] {
    BlockDescription described;
    described.id = "lab.record_outlet";
    described.ports.push_back(message_port(BF_IN, "in"));
    return described;
  }();
  return type;
}

const BlockDescription& record_inlet() {
  static const BlockDescription type = [] {
    BlockDescription described;
    described.id = "lab.record_inlet";
    PortDescription clock;
    clock.direction = BF_OUT;
    clock.name = "clock";
    described.ports.push_back(clock);
    described.ports.push_back(message_port(BF_OUT, "out"));
    return described;
  }();
  return type;
}

MadeEnd make_record_outlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Outlet> outlet) {
  return End::wrap(name, record_outlet(), std::make_shared<RecordOutlet>(cut, std::move(outlet)));
}

MadeEnd make_record_inlet(const std::string& name, const Cut& cut, const Rate& period, std::unique_ptr<transport::Inlet> inlet) {
  return End::wrap(name, record_inlet(), std::make_shared<RecordInlet>(cut, period, std::move(inlet)));
}

}  // namespace bodeflow::lab
