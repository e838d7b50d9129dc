#pragma once

#include "acquisition/device/channels.hpp"
#include "acquisition/device/device_record.hpp"
#include "quantity.hpp"
#include "session.hpp"

namespace bodeflow::acquisition {

/// acquisition.iio: a source whose samples a device of Linux IIO takes.
class IioCapture final : public Block {
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
  void check_rate() const;
  void refill();
  std::size_t until_gap(std::size_t most) const;
  void mark(std::size_t offset, Io& io);

  IioSpec spec_;
  std::string clock_name_;
  bool mark_gaps_ = false;
  Rate rate_;
  Channels channels_;
  std::vector<IioQuantity> quantities_;
  std::optional<IioSession> session_;
  bool running_ = false;
  std::size_t filled_ = 0, taken_ = 0;    // samples of the buffer at hand
  std::optional<std::int64_t> stamp_ns_;  // of the sample before
  std::int64_t received_ = 0;
  DeviceClock clock_;
  DeviceReport report_;
};

}  // namespace bodeflow::acquisition
