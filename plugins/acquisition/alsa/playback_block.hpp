#pragma once

#include "card.hpp"

namespace bodeflow::acquisition {

/// acquisition.alsa_playback: a sink whose samples a sound device gives out.
class AlsaPlayback final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr MessageOut device{0, "device"};
  static constexpr MessageOut gaps{1, "gaps"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  void begin();
  void break_off(Io& io, std::size_t offset);
  void encode_all(std::size_t frames, std::size_t offset, Io& io);

  Card card_;
  std::optional<std::size_t> lead_asked_;
  ScaleSettings scale_;
  Channels channels_;
  Rate rate_;
  std::size_t lead_ = 0;
  std::optional<Pcm> pcm_;
  bool running_ = false;
  std::int64_t base_ = 0;  // position of the first frame behind the silence of the last start
  std::vector<std::uint8_t> bytes_;
  BreakCounter breaks_;
  DeviceClock clock_;
  DeviceReport report_;
};

}  // namespace bodeflow::acquisition
