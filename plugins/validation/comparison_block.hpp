#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "comparison_record.hpp"

namespace bodeflow::validation {

/// validation.comparison: models beside each other, and against measured data.
class ComparisonBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr MessageIn model{0, "model"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void collect(std::span<const double> samples, const char* port, const records::Signals& signal,
               std::vector<double>& into) const;
  std::vector<std::string> names() const;
  Expected<Judgement> judged(std::size_t model, const Measured& data) const;

  std::vector<std::string> names_;
  JudgementSettings settings_;
  Eigen::Index shown_ = 0, limit_ = 0;
  bool has_data_ = false;
  double sample_rate_hz_ = 0.0;
  records::Signals input_signal_, output_signal_;
  std::vector<double> u_, y_;
  std::vector<records::ModelData> models_;
  std::vector<Hold> holds_;  // one a model
};

}  // namespace bodeflow::validation
