#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "critical_frequency.hpp"
#include "designer.hpp"

namespace bodeflow::adaptive_control {

/// RST design at each sample: points of the plant's response to a controller that is fit to run.
class Design final : public Block {
 public:
  static constexpr In<std::complex<double>> response{0, "response"};
  static constexpr In<double> setpoint{1, "setpoint"}, y{2, "y"}, u{3, "u"};
  static constexpr Out<double> coefficients{0, "coefficients"};
  static constexpr MessageIn plan{0, "plan"};
  static constexpr MessageOut controller{0, "controller"}, log{1, "log"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  DesignerSettings at(double sample_time) const;
  void watch(Io& io, std::size_t n);
  void write(Io& io, std::size_t n, const Rst& rst) const;

  DesignerSettings settings_;
  double start_s_ = 0.0, bandwidth_ = 1.0, sample_time_ = 1.0;
  double least_u_ = 0.0, most_u_ = 0.0;
  std::vector<double> omega_;
  std::optional<Designer> designer_;
  CriticalFrequency critical_frequency_;
  Rst last_;
  std::vector<std::complex<double>> points_;
};

}  // namespace bodeflow::adaptive_control
