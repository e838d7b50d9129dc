#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "delay.hpp"
#include "records.hpp"

namespace bodeflow::spectrum {

/// spectrum.delay: the delay in a frequency response.
class DelayBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;

 private:
  DelayProblem problem_of(const ResponseData& data, Eigen::Index output, Eigen::Index input) const;

  std::string output_, input_;
  std::vector<double> band_hz_;
  int slope_ = 0;
  double largest_s_ = 0.0;
};

}  // namespace bodeflow::spectrum
