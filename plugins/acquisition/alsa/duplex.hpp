#pragma once

#include "pcm.hpp"

namespace bodeflow::acquisition {

/// Playback and capture of one card as one clocked pair: frame n of the one leaves at the time at which frame n of the other is
/// taken. What is played comes `lead` frames late, which is what the playback buffer holds; `round_trip` frames of the capture
/// are left out at each start, so that a frame captured is the answer to the one played.
///
/// After an overrun or underrun both start again with what was not played yet: played and captured frames stay together, only
/// time has gone by between two of them.
class Duplex {
 public:
  /// Errors: a playback buffer that does not hold lead and a period, a round trip that the lead does not outlast.
  static Expected<Duplex> make(Pcm playback, Pcm capture, std::size_t lead, std::size_t round_trip);

  /// Of one call of `step`.
  struct Moved {
    std::size_t frames = 0;  ///< captured, and played
    bool broken = false;     ///< both stopped before the rest: `restart`, then `resume`
    bool underrun = false;   ///< by the playback; else by the capture
  };

  /// Forgets what was to be played; the next `step` starts the devices.
  void reset();
  /// Hands over up to `period` frames to be played.
  Expected<Moved> step(const std::uint8_t* play, std::size_t frames, std::uint8_t* played, std::uint8_t* captured);
  /// The rest of a broken step: frames that were handed over, but not captured.
  Expected<Moved> resume(std::size_t frames, std::uint8_t* played, std::uint8_t* captured);
  /// Starts both anew; false: the capture broke off again before its first frame.
  Expected<bool> restart();
  void drop();

  bool linked() const { return linked_; }
  Pcm& capture() { return capture_; }
  const Pcm& playback() const { return playback_; }
  std::size_t lead() const { return lead_; }

 private:
  Duplex(Pcm playback, Pcm capture, std::size_t lead, std::size_t round_trip);
  static Moved broken_off(bool underrun);
  Expected<bool> skip_round_trip();

  Pcm playback_, capture_;
  bool linked_ = false, running_ = false;
  std::size_t lead_, round_trip_;
  std::vector<std::uint8_t> pending_;  // written, and not yet given back as played
  std::size_t pending_frames_ = 0;
  std::vector<std::uint8_t> skipped_;
};

}  // namespace bodeflow::acquisition
