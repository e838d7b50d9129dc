#include "reference_model_block.hpp"

#include <algorithm>

#include "block_settings.hpp"

namespace bodeflow::adaptive_control {

void ReferenceModel::describe(Describe& d) {
  d.id("adaptive_control.reference_model")
      .summary("Gives the output that the desired response makes of a command: what the loop should do.")
      .realtime_safe()
      .cost_ns(30);
  d.doc("G_m(s) = A_m(0) / A_m(s) exp(-s delay) behind a zero-order hold, exact at the samples.");
  describe_desired(d);
  d.stream_in(in).doc("command");
  d.stream_out(out).same_as(in).doc("desired output");
}

void ReferenceModel::configure(const Parameters& p) { desired_ = read_desired(p, 2); }

void ReferenceModel::resolve(Facts& f) {
  if (!f.in(in).known) return;
  if (f.in(in).channels != 1) fail("'in' has " + std::to_string(f.in(in).channels) + " channels; needed: one");
  value_or_fail(desired_points(desired_, 1.0 / f.in(in).rate.hz(), {}));
}

void ReferenceModel::activate(const Activation& a) {
  auto system = value_or_fail(numerics::to_state_space(undelayed(desired_)));
  model_ = value_or_fail(numerics::zero_order_hold(system, 1.0 / a.rate.hz(), desired_.delay_s));
  reset();
}

void ReferenceModel::reset() {
  state_ = next_ = Eigen::VectorXd::Zero(model_.model.states());
  late_.assign(static_cast<std::size_t>(model_.delay) + 1, 0.0);
  at_ = 0;
}

void ReferenceModel::process(Io& io) {
  const auto command = io.read(in);
  const auto y = io.write(out);
  for (std::size_t n = 0; n < io.count(); ++n) {
    late_[at_] = command[n];
    y[n] = model_.model.C.row(0).dot(state_);
    at_ = (at_ + 1) % late_.size();  // now the oldest: command[n - delay]
    next_.noalias() = model_.model.A.lazyProduct(state_);
    next_ += model_.model.B.col(0) * late_[at_];
    state_.swap(next_);
  }
}

}  // namespace bodeflow::adaptive_control
