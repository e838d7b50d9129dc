#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "estimator_bank.hpp"

namespace bodeflow::adaptive_control {

/// Band-pass filters and frequency point estimators: plant signals to points of the plant's response, sample by sample.
class Estimator final : public Block {
 public:
  static constexpr In<double> y{0, "y"}, u{1, "u"}, reference{2, "reference"};
  static constexpr Out<std::complex<double>> response{0, "response"};
  static constexpr MessageIn plan{0, "plan"};
  static constexpr MessageOut result{0, "result"}, log{1, "log"};

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
  BankSettings settings_, planned_;
  std::optional<EstimatorBank> bank_;
  double sample_time_ = 1.0;
};

}  // namespace bodeflow::adaptive_control
