#pragma once

#include "card.hpp"
#include "duplex.hpp"

namespace bodeflow::acquisition {

/// acquisition.alsa_duplex: plays and captures on one sound card, sample by sample together.
class AlsaDuplex final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> played{0, "played"};
  static constexpr Out<double> captured{1, "captured"};
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
  Pcm open(Direction direction, std::size_t channels) const;
  void encode_all(std::size_t frames, std::size_t offset, Io& io);
  void decode_all(std::size_t frames, std::size_t offset, Io& io);
  void break_off(bool underrun, std::size_t offset, Io& io);

  Card card_;
  std::string capture_device_;
  std::optional<std::size_t> lead_asked_;
  std::size_t round_trip_ = 0;
  ScaleSettings play_scale_;
  Channels play_, capture_;
  std::optional<double> ac_corner_hz_;
  Rate rate_;
  std::optional<Duplex> duplex_;
  std::int64_t base_ = 0;  // position of the first frame since the last start
  std::vector<std::uint8_t> to_play_, played_, captured_;
  BreakCounter breaks_;
  DeviceClock clock_;
  DeviceReport report_;
};

}  // namespace bodeflow::acquisition
