#pragma once

#include <Eigen/Core>
#include <bodeflow/block.hpp>
#include <bodeflow/numerics/discretise.hpp>
#include <vector>

#include "desired_response.hpp"

namespace bodeflow::adaptive_control {

/// What the desired response makes of a command.
class ReferenceModel final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;

 private:
  DesiredResponse desired_;
  numerics::DelayedModel model_;
  Eigen::VectorXd state_, next_;
  std::vector<double> late_;
  std::size_t at_ = 0;
};

}  // namespace bodeflow::adaptive_control
