#pragma once

#include "card.hpp"

namespace bodeflow::acquisition {

/// acquisition.alsa_capture: a source whose samples a sound device takes.
class AlsaCapture final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};
  static constexpr MessageOut device{0, "device"};
  static constexpr MessageOut gaps{1, "gaps"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  void begin();
  void break_off(Io& io, std::size_t offset);
  void decode_all(std::size_t frames, std::size_t offset, Io& io);

  Card card_;
  Rate rate_;
  Channels channels_;
  std::optional<double> ac_corner_hz_;
  std::optional<Pcm> pcm_;
  bool running_ = false;
  std::int64_t base_ = 0;  // position of the first frame since the last start
  std::vector<std::uint8_t> bytes_;
  BreakCounter breaks_;
  DeviceClock clock_;
  DeviceReport report_;
};

}  // namespace bodeflow::acquisition
