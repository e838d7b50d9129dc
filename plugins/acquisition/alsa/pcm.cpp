#include "pcm.hpp"

#include <alsa/asoundlib.h>

#include <algorithm>

#include "acquisition/sampling.hpp"
#include "pcm_setup.hpp"

namespace bodeflow::acquisition {
namespace {

/// Waits are cut to this, so that a device that fails without a word is looked at.
constexpr int kLongestWait_ms = 50;

/// libasound prints to standard error by itself; what matters is in our own messages. (Its handler for one thread has no C
/// linkage in the header of 1.2.8, so this is the one for all; devices are opened on one thread.)
void say_nothing(const char*, int, const char*, int, const char*, ...) {}

class Silence {
 public:
  Silence() { snd_lib_error_set_handler(say_nothing); }
  ~Silence() { snd_lib_error_set_handler(nullptr); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
};

double seconds_of(const snd_htimestamp_t& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void Pcm::Close::operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }

Unexpected<Error> Pcm::refused(const char* what, int code) const {
  return unexpected(name_of(spec_) + " " + what + ": " + snd_strerror(code));
}

Expected<Pcm> Pcm::open(const PcmSpec& spec) {
  const Silence silence;
  Pcm made;
  made.spec_ = spec;
  snd_pcm_t* pcm = nullptr;
  const auto stream = spec.direction == Direction::capture ? SND_PCM_STREAM_CAPTURE : SND_PCM_STREAM_PLAYBACK;
  const int code = snd_pcm_open(&pcm, spec.device.c_str(), stream, SND_PCM_NONBLOCK);
  made.pcm_.reset(pcm);
  if (code < 0) {
    const char* list = spec.direction == Direction::capture ? "arecord -l" : "aplay -l";
    return unexpected(name_of(spec) + " can't be opened: " + snd_strerror(code) + "; `" + list + "` lists what there is");
  }
  if (auto set = set_up(pcm, made.spec_); !set) return {Unexpected<Error>{set.error()}};
  return made;
}

template <class Transfer>
Expected<Pcm::Moved> Pcm::move(std::size_t frames, Transfer&& transfer) {
  Moved moved;
  double idle_since = monotonic_s();
  while (moved.frames < frames) {
    const auto done = transfer(moved.frames, static_cast<snd_pcm_uframes_t>(frames - moved.frames));
    if (done > 0) {
      moved.frames += static_cast<std::size_t>(done);
      moved_ += done;
      idle_since = monotonic_s();
      continue;
    }
    if (done == -EPIPE || done == -ESTRPIPE) {
      moved.broken = true;
      return moved;
    }
    if (done < 0 && done != -EAGAIN && done != -EINTR) return refused("failed", static_cast<int>(done));
    if (monotonic_s() - idle_since > spec_.timeout_s)
      return unexpected(name_of(spec_) + (spec_.direction == Direction::capture ? " delivered" : " took") + " nothing for " +
                        short_text(spec_.timeout_s) + " s");
    snd_pcm_wait(pcm_.get(), kLongestWait_ms);  // what it says is told by the next transfer
  }
  return moved;
}

Expected<Pcm::Moved> Pcm::read(std::uint8_t* to, std::size_t frames) {
  return move(frames,
              [&](std::size_t at, snd_pcm_uframes_t count) { return snd_pcm_readi(pcm_.get(), to + at * frame_bytes(), count); });
}

Expected<Pcm::Moved> Pcm::write(const std::uint8_t* from, std::size_t frames) {
  return move(frames, [&](std::size_t at, snd_pcm_uframes_t count) {
    return snd_pcm_writei(pcm_.get(), from + at * frame_bytes(), count);
  });
}

Expected<void> Pcm::prepare() {
  snd_pcm_drop(pcm_.get());
  moved_ = 0;
  if (const int code = snd_pcm_prepare(pcm_.get()); code < 0) return refused("can't be made ready", code);
  return {};
}

Expected<void> Pcm::start() {
  if (snd_pcm_state(pcm_.get()) == SND_PCM_STATE_RUNNING) return {};  // with its group
  if (const int code = snd_pcm_start(pcm_.get()); code < 0) return refused("does not start", code);
  return {};
}

void Pcm::drop() { snd_pcm_drop(pcm_.get()); }

Expected<void> Pcm::play_out() {
  const double most_s = spec_.timeout_s + static_cast<double>(spec_.buffer) / spec_.rate_hz;
  const double begun = monotonic_s();
  while (monotonic_s() - begun < most_s) {
    const auto free = snd_pcm_avail(pcm_.get());
    if (free < 0 || free >= static_cast<snd_pcm_sframes_t>(spec_.buffer)) return {};  // it ran dry
    const double left_s = (static_cast<double>(spec_.buffer) - static_cast<double>(free)) / spec_.rate_hz;
    const timespec pause{0, static_cast<long>(1e9 * std::clamp(left_s, 1e-3, 0.05))};
    nanosleep(&pause, nullptr);
  }
  return unexpected(name_of(spec_) + " does not play what stands in its buffer");
}

bool Pcm::link(Pcm& a, Pcm& b) {
  const Silence silence;
  return snd_pcm_link(a.pcm_.get(), b.pcm_.get()) == 0;
}

std::optional<TimeStamp> Pcm::stamp() {
  snd_pcm_uframes_t available = 0;
  snd_htimestamp_t time{};
  if (snd_pcm_htimestamp(pcm_.get(), &available, &time) < 0 || (time.tv_sec == 0 && time.tv_nsec == 0)) return std::nullopt;
  const auto waiting = static_cast<std::int64_t>(available);
  const std::int64_t queued = static_cast<std::int64_t>(spec_.buffer) - waiting;
  TimeStamp stamp;
  stamp.position = spec_.direction == Direction::capture ? moved_ + waiting : moved_ - queued;
  stamp.time_s = seconds_of(time);
  return stamp;
}

double Pcm::started_s() const {
  snd_pcm_status_t* status = nullptr;
  snd_htimestamp_t time{};
  if (snd_pcm_status_malloc(&status) == 0 && snd_pcm_status(pcm_.get(), status) == 0)
    snd_pcm_status_get_trigger_htstamp(status, &time);
  snd_pcm_status_free(status);
  const double stamp_s = seconds_of(time);
  return stamp_s > 0.0 ? stamp_s : monotonic_s();  // some drivers do not tell
}

}  // namespace bodeflow::acquisition
