#include "execute/limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "execute/run.hpp"

namespace bodeflow::execute {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A signal that changes exactly as fast as allowed is not stopped by the rounding of its own samples.
constexpr double kRateRounding = 1e-9;
constexpr double kValueRounding = 4.0 * std::numeric_limits<double>::epsilon();

/// Returned in the block's place when a limit ends the run; BlockRun::guard knows which.
constexpr std::int32_t kStopped = -1;

}  // namespace

Limiter::Limiter(const plan::Limit& limit)
    : limit_(limit),
      step_(limit.rate / limit.sample_rate_hz),
      clamps_(limit.input && limit.on_violation == graph::OnViolation::clamp),
      channels_(limit.channels.size()),
      lowest_(kInfinity),
      highest_(-kInfinity) {
  if (!limit.input) return;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    channels_[c].before = limit.start[c];
    channels_[c].has_before = true;
  }
}

Bound Limiter::bound_of(const Channel& channel, double x) const {
  if (!std::isfinite(x)) return Bound::finite;
  if (x < limit_.min) return Bound::min;
  if (x > limit_.max) return Bound::max;
  if (!channel.has_before || step_ == kInfinity) return Bound::none;
  const double room = step_ * (1.0 + kRateRounding) + kValueRounding * std::max(std::abs(x), std::abs(channel.before));
  return std::abs(x - channel.before) > room ? Bound::rate : Bound::none;
}

/// The sample nearest to x that is allowed; `before` is allowed, so that both bounds hold.
double Limiter::held(const Channel& channel, double x) const {
  if (!std::isfinite(x)) return channel.before;
  const double y = std::clamp(x, limit_.min, limit_.max);
  return std::clamp(y, channel.before - step_, channel.before + step_);
}

void Limiter::observe(Channel& channel, double x) {
  ++samples_;
  if (!std::isfinite(x)) {
    channel.has_last = false;
    return;
  }
  lowest_ = std::min(lowest_, x);
  highest_ = std::max(highest_, x);
  if (channel.has_last) {
    steepest_ = std::max(steepest_, std::abs(x - channel.last));
    any_step_ = true;
  }
  channel.last = x;
  channel.has_last = true;
}

void Limiter::count(Bound bound, std::size_t channel, double x, std::uint64_t position) {
  ++violations_;
  if (violations_ > 1) return;
  const double value = bound == Bound::rate ? (x - channels_[channel].before) * limit_.sample_rate_hz : x;
  first_ = {bound, channel, position, static_cast<double>(position) / limit_.sample_rate_hz, value};
  violated_.store(true, std::memory_order_release);
}

double Limiter::look(std::size_t index, double x, std::uint64_t position) {
  Channel& channel = channels_[index];
  observe(channel, x);
  const Bound bound = bound_of(channel, x);
  violated_now_ = bound != Bound::none;
  if (violated_now_) count(bound, index, x, position);
  const double y = violated_now_ && clamps_ ? held(channel, x) : x;
  if (std::isfinite(y)) {
    channel.before = y;
    channel.has_before = true;
  }
  return y;
}

LimitRecord Limiter::record() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  LimitRecord record{samples_, violations_, {}, kNone, kNone, kNone};
  if (violations_ > 0) record.first = first_;
  if (lowest_ <= highest_) {
    record.lowest = lowest_;
    record.highest = highest_;
  }
  if (any_step_) record.steepest = steepest_ * limit_.sample_rate_hz;
  return record;
}

bool Limiter::news() {
  if (told_ || !violated_.load(std::memory_order_acquire)) return false;
  told_ = true;
  return true;
}

Guard::Guard(BlockRun& block) : block_(block), call_(block.call), shown_(block.inputs) {
  block.call = process;
  block.guard = this;
}

Guard::Port& Guard::port_of(std::vector<Port>& ports, std::size_t stream) {
  const auto known = std::find_if(ports.begin(), ports.end(), [&](const Port& port) { return port.stream == stream; });
  if (known != ports.end()) return *known;
  ports.push_back({stream, {}, {}, false});
  return ports.back();
}

void Guard::add(Run& run, const graph::Limit& written, Limiter& limiter, int limit) {
  const auto index = static_cast<std::size_t>(written.port.port);
  Port& port = written.input ? port_of(inputs_, index) : port_of(outputs_, block_.inputs + index);
  port.limits.push_back({&limiter, limit});
  if (!written.input || written.on_violation != graph::OnViolation::clamp || !port.memory.empty()) return;
  const std::uint32_t channels = block_.streams[port.stream].channel_count;
  const auto capacity = static_cast<std::uint64_t>(run.chunking.periods * block_.per_repetition) * block_.ports[index].samples;
  const BufferView& buffer = run.memory[run.memory.add_scratch(BF_F64, channels, capacity)];
  for (std::uint32_t c = 0; c < channels; ++c) port.memory.push_back(buffer.at(0, c, 0));
}

std::int32_t Guard::process(void*, bf_process* process) {
  return static_cast<BlockRun*>(process->context)->guard->process(*process);
}

std::int32_t Guard::process(bf_process& process) {
  const auto asked = static_cast<std::int64_t>(process.count);
  const std::int64_t allowed = look(inputs_, asked);
  if (allowed < asked) {
    set_count(block_, allowed);
    process.count = process.done = static_cast<std::uint64_t>(allowed);
    if (allowed == 0) return kStopped;
  }
  show_inputs();
  const std::int32_t status = call_(block_.self, &process);
  process.inputs = block_.streams.data();
  if (status != BF_OK || block_.fault) return status;
  const auto made = static_cast<std::int64_t>(std::min(process.done, process.count));
  if (const std::int64_t good = look(outputs_, made); good < made) process.done = static_cast<std::uint64_t>(good + 1);
  return stopped_ >= 0 ? kStopped : status;
}

/// Firings until a limit ends the run, that one not counted; all of them where none does.
std::int64_t Guard::look(std::vector<Port>& ports, std::int64_t firings) {
  for (Port& port : ports) port.changed = false;
  if (ports.empty()) return firings;
  for (std::int64_t firing = 0; firing < firings; ++firing)
    for (Port& port : ports)
      if (!look_at(port, firing)) return firing;
  return firings;
}

/// False: a limit ends the run.
bool Guard::look_at(Port& port, std::int64_t firing) {
  const bf_stream& stream = block_.streams[port.stream];
  const std::uint32_t samples = block_.ports[port.stream].samples;
  const auto first = static_cast<std::uint64_t>(firing) * samples;
  const auto base = static_cast<std::uint64_t>(block_.position) * samples;
  for (std::uint64_t n = first; n < first + samples; ++n) {
    for (const Placed& placed : port.limits) {
      const auto& channels = placed.limiter->limit().channels;
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto* now = static_cast<const double*>(port.changed ? port.memory[channels[c]] : stream.channels[channels[c]]);
        const double x = now[port.changed ? n : stream.offset + n];
        const double y = placed.limiter->look(c, x, base + n);
        if (placed.limiter->stops()) {
          stopped_ = placed.limit;
          return false;
        }
        if (placed.limiter->holds()) change(port, stream, channels[c], n, y);
      }
    }
  }
  return true;
}

/// Puts y in the place of a sample; the first time in a call the others are copied.
void Guard::change(Port& port, const bf_stream& stream, std::uint32_t channel, std::uint64_t sample, double y) {
  if (!port.changed)
    for (std::size_t c = 0; c < port.memory.size(); ++c)
      std::memcpy(port.memory[c], static_cast<const double*>(stream.channels[c]) + stream.offset, stream.count * sizeof(double));
  port.changed = true;
  static_cast<double*>(port.memory[channel])[sample] = y;
}

void Guard::show_inputs() {
  const bool any = std::any_of(inputs_.begin(), inputs_.end(), [](const Port& port) { return port.changed; });
  if (!any) return;
  std::copy_n(block_.streams.begin(), block_.inputs, shown_.begin());
  for (const Port& port : inputs_) {
    if (!port.changed) continue;
    shown_[port.stream].channels = port.memory.data();
    shown_[port.stream].offset = 0;
  }
  block_.process.inputs = shown_.data();
}

void guard_limits(Run& run) {
  for (const plan::Limit& limit : run.plan->limits) run.limiters.push_back(std::make_unique<Limiter>(limit));
  for (std::size_t i = 0; i < run.limiters.size(); ++i) {
    const graph::Limit& written = run.phase->limits[i];
    BlockRun& block = run.block(written.port.block);
    if (block.guard == nullptr) run.guards.push_back(std::make_unique<Guard>(block));
    block.guard->add(run, written, *run.limiters[i], static_cast<int>(i));
  }
}

}  // namespace bodeflow::execute
