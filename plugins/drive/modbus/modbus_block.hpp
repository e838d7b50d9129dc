#pragma once

#include <bodeflow/block.hpp>
#include <memory>

#include "poller.hpp"

namespace bodeflow::drive::modbus {

/// drive.modbus: a drive behind Modbus TCP or RTU.
class ModbusBlock final : public Block {
 public:
  static constexpr In<double> set_points{0, "set_points"};
  static constexpr Out<double> measurements{0, "measurements"};
  static constexpr Out<double> feedback{1, "feedback"};
  static constexpr Out<double> status{2, "status"};
  static constexpr MessageOut report{0, "report"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;
  void finish(Io& io) override;
  void deactivate() override;

 private:
  std::vector<std::size_t> select(const std::vector<std::string>& names, const char* parameter, bool writable) const;
  void select_feedback(const std::vector<std::string>& names);
  void check_map() const;
  void check_watchdog(const Register& r) const;
  void check_line() const;
  void check_set_points(const StreamFacts& u) const;
  void take_set_points(Io& io, std::size_t n);
  void write(Io& io, std::size_t n) const;
  [[noreturn]] void stop_and_fail(const std::string& reason);

  SessionSetup setup_;
  std::vector<std::size_t> feedback_;  // places in setup_.measurements
  double poll_hz_ = 0.0;
  DriveCommand command_ = DriveCommand::enable;
  std::unique_ptr<Poller> poller_;
  std::vector<double> wanted_;
  Polled newest_;
};

}  // namespace bodeflow::drive::modbus
