#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <string>
#include <vector>

#include "motor_estimate.hpp"

namespace bodeflow::frisch {

/// frisch.motor: the model of an induction motor at standstill from noisy voltage and current.
class Motor final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageIn matrix{1, "matrix"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut identifiable{1, "identifiable"};
  static constexpr MessageOut physical{2, "physical"};
  static constexpr MessageOut fitted{3, "fitted_response"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void configure_lines(const Parameters& p);
  void keep(Io& io, In<double> port, std::vector<double>& to) const;
  Band streamed_band() const;
  std::vector<Band> measured_bands() const;
  std::vector<Band> parts_of(const std::vector<Band>& bands) const;

  MotorSettings settings_;
  std::string input_is_, band_;
  Eigen::Index period_ = 0, skip_ = 0, step_ = 0;  // of the streams; period 0: not given
  std::vector<Eigen::Index> lines_;                // empty: the excited ones

  double sample_rate_hz_ = 0.0;
  std::string input_name_, output_name_, input_unit_, output_unit_;
  std::vector<double> input_samples_, output_samples_;
  std::vector<Band> responses_, matrices_;
};

}  // namespace bodeflow::frisch
