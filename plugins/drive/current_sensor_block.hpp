#pragma once

#include <bodeflow/block.hpp>
#include <vector>

#include "sensor_dynamics.hpp"
#include "sensor_errors.hpp"

namespace bodeflow::drive {

/// drive.current_sensor: a Hall sensor with lag, delay, gain, offset, hum and noise.
class CurrentSensor final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr MessageIn properties{0, "properties"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;
  void reset() override;

 private:
  struct Specification {
    SensorErrors errors;
    double lag_s = 0.0;
    double delay_s = 0.0;
  };
  void set_dynamics();

  Specification declared_, actual_;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
  int channels_ = 0;
  double rate_hz_ = 0.0;
  double correction_ = 0.0;
  std::vector<SensorDynamics> dynamics_;
  std::vector<numerics::Random> random_;
};

}  // namespace bodeflow::drive
