#pragma once

#include <bodeflow/error.hpp>
#include <memory>

#include "acquisition/device/device_clock.hpp"
#include "sample_format.hpp"

typedef struct _snd_pcm snd_pcm_t;

namespace bodeflow::acquisition {

enum class Direction { capture, playback };

/// What is asked of a sound device. It gives exactly this, or is refused, but for period and buffer, which it may make larger.
struct PcmSpec {
  std::string device = "default";
  Direction direction = Direction::capture;
  unsigned rate_hz = 48000;
  unsigned channels = 2;
  SampleFormat format = SampleFormat::s32;
  std::size_t period = 256;   ///< frames between interrupts
  std::size_t buffer = 4096;  ///< frames
  double timeout_s = 2.0;     ///< a device that moves nothing for so long has failed
};

/// One direction of a sound device through libasound: interleaved frames, waits that end.
class Pcm {
 public:
  /// Opens and sets up a device; it is not started. Errors: device, what was found, what it allows.
  static Expected<Pcm> open(const PcmSpec& spec);

  /// Of one read or write.
  struct Moved {
    std::size_t frames = 0;
    bool broken = false;  ///< an overrun or underrun came before the rest: `prepare` and `start` go on
  };
  /// Takes `frames` frames. Errors: the device delivers nothing, is gone, or refuses.
  Expected<Moved> read(std::uint8_t* to, std::size_t frames);
  Expected<Moved> write(const std::uint8_t* from, std::size_t frames);

  /// Empties the buffer and makes the device ready.
  Expected<void> prepare();
  /// A device of a group starts all of it.
  Expected<void> start();
  /// Ends at once; what stands in the buffer is lost.
  void drop();
  /// Returns once all that was written was played.
  Expected<void> play_out();

  /// Makes both start and stop together; false where the devices can't.
  static bool link(Pcm& a, Pcm& b);

  /// Frames that the device has taken or given since `start`, and when; none where it does not tell.
  std::optional<TimeStamp> stamp();

  /// When it started, on the monotonic clock of the machine: the time of the first frame.
  double started_s() const;

  const PcmSpec& spec() const { return spec_; }  ///< with the sizes that the device has
  std::size_t frame_bytes() const { return spec_.channels * bytes_of(spec_.format); }

 private:
  struct Close {
    void operator()(snd_pcm_t* pcm) const;
  };

  Unexpected<Error> refused(const char* what, int code) const;
  template <class Transfer>
  Expected<Moved> move(std::size_t frames, Transfer&& transfer);

  PcmSpec spec_;
  std::unique_ptr<snd_pcm_t, Close> pcm_;
  std::int64_t moved_ = 0;  ///< frames since `start`; what was written before it counts
};

}  // namespace bodeflow::acquisition
