#include "duplex.hpp"

#include <cstring>

#include "pcm_setup.hpp"

namespace bodeflow::acquisition {
Duplex::Duplex(Pcm playback, Pcm capture, std::size_t lead, std::size_t round_trip)
    : playback_(std::move(playback)), capture_(std::move(capture)), lead_(lead), round_trip_(round_trip) {
  linked_ = Pcm::link(capture_, playback_);
  pending_.resize((lead_ + playback_.spec().period) * playback_.frame_bytes());
  skipped_.resize(capture_.spec().period * capture_.frame_bytes());
}

Expected<Duplex> Duplex::make(Pcm playback, Pcm capture, std::size_t lead, std::size_t round_trip) {
  const PcmSpec& play = playback.spec();
  if (lead + play.period > play.buffer)
    return unexpected(name_of(play) + " buffers " + std::to_string(play.buffer) + " frames; lead and a period of " +
                      std::to_string(play.period) + " need " + std::to_string(lead + play.period) +
                      ": raise buffer or lower lead");
  if (round_trip + play.period > lead)
    return unexpected("a round_trip_delay of " + std::to_string(round_trip) + " samples and a period of " +
                      std::to_string(play.period) + " with a lead of " + std::to_string(lead) +
                      ": the playback would run dry; raise lead to " + std::to_string(round_trip + 2 * play.period) + " or more");
  Duplex made(std::move(playback), std::move(capture), lead, round_trip);
  made.reset();
  return made;
}

void Duplex::reset() {
  drop();
  running_ = false;
  pending_frames_ = lead_;
  std::memset(pending_.data(), 0, pending_.size());
}

void Duplex::drop() {
  playback_.drop();
  capture_.drop();
}

Expected<bool> Duplex::restart() {
  running_ = true;
  for (Pcm* pcm : {&playback_, &capture_})
    if (auto done = pcm->prepare(); !done) return {Unexpected<Error>{done.error()}};
  const auto filled = playback_.write(pending_.data(), pending_frames_);
  if (!filled) return {Unexpected<Error>{filled.error()}};
  for (Pcm* pcm : {&playback_, &capture_})
    if (auto done = pcm->start(); !done) return {Unexpected<Error>{done.error()}};
  return skip_round_trip();
}

Expected<bool> Duplex::skip_round_trip() {
  const std::size_t period = capture_.spec().period;
  for (std::size_t left = round_trip_; left > 0;) {
    const auto moved = capture_.read(skipped_.data(), std::min(left, period));
    if (!moved) return {Unexpected<Error>{moved.error()}};
    if (moved->broken) return false;
    left -= moved->frames;
  }
  return true;
}

Duplex::Moved Duplex::broken_off(bool underrun) {
  Moved moved;
  moved.broken = true;
  moved.underrun = underrun;
  return moved;
}

Expected<Duplex::Moved> Duplex::step(const std::uint8_t* play, std::size_t frames, std::uint8_t* played, std::uint8_t* captured) {
  const std::size_t bytes = playback_.frame_bytes();
  std::memcpy(pending_.data() + pending_frames_ * bytes, play, frames * bytes);
  pending_frames_ += frames;
  if (!running_) {
    const auto started = restart();
    if (!started) return {Unexpected<Error>{started.error()}};
    if (!*started) return broken_off(false);
  } else {
    const auto written = playback_.write(play, frames);
    if (!written) return {Unexpected<Error>{written.error()}};
    if (written->broken) return broken_off(true);
  }
  return resume(frames, played, captured);
}

Expected<Duplex::Moved> Duplex::resume(std::size_t frames, std::uint8_t* played, std::uint8_t* captured) {
  const auto read = capture_.read(captured, frames);
  if (!read) return {Unexpected<Error>{read.error()}};
  const std::size_t bytes = playback_.frame_bytes();
  std::memcpy(played, pending_.data(), read->frames * bytes);
  pending_frames_ -= read->frames;
  std::memmove(pending_.data(), pending_.data() + read->frames * bytes, pending_frames_ * bytes);
  Moved moved;
  moved.frames = read->frames;
  moved.broken = read->broken;
  return moved;
}

}  // namespace bodeflow::acquisition
