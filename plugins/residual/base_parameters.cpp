#include "base_parameters.hpp"

#include "motor_standstill.hpp"

namespace bodeflow::residual {

void describe_base(Describe& d) {
  d.parameter("base", "motor_standstill")
      .choices({"motor_standstill"})
      .doc("what the plant is declared to be: an induction motor at standstill, one phase, with gamma, alpha, Lm_beta and sigma");
  d.parameter("input", "command")
      .choices({"command", "period_mean", "terminal"})
      .doc(
          "which voltage the recordings have as input: the command (held over each sample, applied after the computation delay), "
          "the "
          "mean terminal voltage of each sample period, or the terminal voltage sampled without aliasing");
  d.parameter("computation_delay", 0.0).unit("s").range(0, 1).doc("from the sample of a command to the instant it acts");
}

std::unique_ptr<const BaseModel> base_model(const Parameters& p) {
  const std::string& name = p.text("input");
  const MotorInput input = name == "command"       ? MotorInput::command
                           : name == "period_mean" ? MotorInput::period_mean
                                                   : MotorInput::terminal;
  if (input != MotorInput::command && p.number("computation_delay") > 0.0)
    fail("computation_delay belongs to a command; input is '" + name + "', which is measured behind it");
  return std::make_unique<MotorStandstill>(input, p.number("computation_delay"));
}

}  // namespace bodeflow::residual
