#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "motor.hpp"
#include "terminal_contact.hpp"

namespace bodeflow::drive {

/// An induction motor, sampled at the start of each PWM period.
class InductionMotor final : public Block {
 public:
  static constexpr In<double> legs{0, "legs"};
  static constexpr In<double> voltage{1, "voltage"};
  static constexpr In<double> load_torque{2, "load_torque"};
  static constexpr Out<double> current{0, "current"};
  static constexpr Out<double> torque{1, "torque"};
  static constexpr Out<double> speed{2, "speed"};
  static constexpr Out<double> position{3, "position"};
  static constexpr Out<double> flux{4, "flux"};
  static constexpr MessageIn properties{0, "properties"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void reset() override;

 private:
  MotorSetup setup_for(int axes) const;
  void state_notes(const StreamFacts& from, StreamFacts& to, int axes) const;
  void advance(Io& io, std::size_t n);
  void advance_legs(Io& io, std::size_t n, double load);
  void write(Io& io, std::size_t n) const;
  void warm();
  void take_faults(const ContactFaults& faults);

  MotorSetup given_;  // as the parameters say
  MotorSetup setup_;  // with the properties of a record
  int axes_ = 0;      // 0: without supply
  std::unique_ptr<Motor> motor_;
  std::uint64_t periods_ = 0;
  std::uint64_t warm_every_ = 1;
  ContactFaults given_faults_, faults_;
  std::optional<TerminalContact> contact_;  // where the terminal has a fault
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
};

}  // namespace bodeflow::drive
