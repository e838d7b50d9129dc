#pragma once

#include <bodeflow/block.hpp>

#include "coefficient_stream.hpp"
#include "rst_controller.hpp"

namespace bodeflow::adaptive_control {

/// An RST controller with fixed coefficients or with those of a stream, limits and anti-windup.
class RstBlock final : public Block {
 public:
  static constexpr In<double> setpoint{0, "setpoint"}, y{1, "y"}, coefficients{2, "coefficients"};
  static constexpr Out<double> u{0, "u"};
  static constexpr MessageOut report{0, "report"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void read(Io& io, std::size_t n);

  Rst rst_;
  Coefficients anti_windup_{};
  bool fixed_ = false;
  double least_ = 0.0, most_ = 0.0;
  std::string unit_;
  RstController controller_;
  std::int64_t samples_ = 0, saturated_ = 0;
};

}  // namespace bodeflow::adaptive_control
