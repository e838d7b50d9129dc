#pragma once

#include <bodeflow/block.hpp>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "desired_response.hpp"

namespace bodeflow::adaptive_control {

/// Collects an adaptive run and says how well it went.
class Evaluation final : public Block {
 public:
  static constexpr In<double> command{0, "command"}, y{1, "y"}, u{2, "u"}, desired{3, "desired"};
  static constexpr In<std::complex<double>> response{4, "response"};
  static constexpr In<double> coefficients{5, "coefficients"}, beside{6, "beside"};
  static constexpr MessageIn estimator_log{0, "estimator_log"}, design_log{1, "design_log"};
  static constexpr MessageOut result{0, "result"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  using Channels = std::vector<std::vector<double>>;
  double rms(std::size_t from, std::size_t to) const;
  void add_windows(RecordBuilder& r) const;
  void add_truth(RecordBuilder& r) const;
  void add_actions(RecordBuilder& r);

  std::vector<double> windows_s_, omega_;
  std::vector<std::string> coefficient_names_;
  std::optional<numerics::TransferFunction> plant_;
  double delay_s_ = 0.0, from_s_ = 0.0, sample_time_ = 1.0;
  std::vector<double> command_, y_, u_, desired_, beside_;
  std::vector<std::vector<std::complex<double>>> response_;
  Channels coefficients_;
  struct Action {
    double sample = 0.0;
    std::string text;
  };
  std::vector<Action> actions_;
  std::int64_t more_actions_ = 0;
};

}  // namespace bodeflow::adaptive_control
