#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>

#include "pwm.hpp"

namespace bodeflow::drive {

/// A three-phase inverter: switching instants and mean voltage of each PWM period.
class Inverter final : public Block {
 public:
  static constexpr In<double> reference{0, "reference"};
  static constexpr In<double> current{1, "current"};
  static constexpr In<double> measured_current{2, "measured_current"};
  static constexpr Out<double> legs{0, "legs"};
  static constexpr Out<double> voltage{1, "voltage"};
  static constexpr MessageIn properties{0, "properties"};
  static constexpr MessageOut report{0, "report"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void change(const Parameters& p) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void require_currents(Io& io) const;
  AlphaBeta read_vector(Io& io, In<double> port, std::size_t n) const;
  void write_legs(Io& io, std::size_t n, const Switching& s, double rise) const;
  double link_rise(std::uint64_t period) const;

  Modulation given_;       // as the parameters say
  Modulation modulation_;  // with the properties of a record
  double pwm_hz_ = 0.0;
  bool compensated_ = false;
  double compensation_time_s_ = -1.0;  // negative: the dead time
  bool averaged_ = false;
  std::int64_t delay_ = 0;
  bool vector_ = false;  // two channels: alpha and beta
  std::int64_t periods_ = 0, limited_ = 0;
  double largest_ = 0.0;
  double declared_ripple_ = 0.0, ripple_ = 0.0, ripple_hz_ = 100.0;
};

}  // namespace bodeflow::drive
