#include "first_order_hold.hpp"

namespace bodeflow::validation {
namespace {

/// x(t + time) = phi x(t) + held u(t) + rising (u(t + sample time) - u(t)).
struct Step {
  Eigen::MatrixXd phi;
  Eigen::VectorXd held, rising;
};

numerics::Expected<Step> step(const numerics::StateSpace& system, double time_s, double sample_time_s) {
  const Eigen::Index n = system.states();
  numerics::StateSpace wide;
  wide.A = Eigen::MatrixXd::Zero(n + 1, n + 1);
  if (n > 0) wide.A.topRows(n) << system.A, system.B;
  wide.B = Eigen::MatrixXd::Zero(n + 1, 1);
  wide.B(n, 0) = 1.0;
  wide.C = Eigen::MatrixXd::Zero(1, n + 1);
  wide.D = Eigen::MatrixXd::Zero(1, 1);
  const auto held = numerics::zero_order_hold(wide, time_s, 0.0);
  if (!held) return tl::make_unexpected(held.error());
  return Step{held->model.A.topLeftCorner(n, n), held->model.A.topRightCorner(n, 1).col(0),
              held->model.B.col(0).head(n) / sample_time_s};
}

}  // namespace

numerics::Expected<numerics::DelayedModel> first_order_hold(const numerics::StateSpace& system, double sample_time_s,
                                                            double delay_s) {
  // Its refusals are the same.
  const auto checked = numerics::zero_order_hold(system, sample_time_s, delay_s);
  if (!checked) return tl::make_unexpected(checked.error());
  const auto whole = step(system, sample_time_s, sample_time_s);
  if (!whole) return tl::make_unexpected(whole.error());
  const Eigen::Index n = system.states();
  const double direct = system.D(0, 0);
  numerics::DelayedModel result{system, checked->delay};
  numerics::StateSpace& s = result.model;
  s.sample_time = sample_time_s;
  const double rest = numerics::split_delay(delay_s, sample_time_s).rest_s;
  if (!(rest > 0.0)) {
    s.A = whole->phi;
    s.B = whole->held - whole->rising + whole->phi * whole->rising;
    s.D(0, 0) = direct + (system.C * whole->rising).sum();
    return result;
  }
  // The output lies `lead` after the last sample but one; the state is that sample's, with its input.
  const double lead = sample_time_s - rest;
  const auto part = step(system, lead, sample_time_s);
  if (!part) return tl::make_unexpected(part.error());
  const double rising = (system.C * part->rising).sum() + direct * lead / sample_time_s;
  s.A = Eigen::MatrixXd::Zero(n + 1, n + 1);
  s.A.topLeftCorner(n, n) = whole->phi;
  s.A.topRightCorner(n, 1) = whole->held - whole->rising;
  s.B = Eigen::MatrixXd::Ones(n + 1, 1);
  s.B.topRows(n) = whole->rising;
  s.C.resize(1, n + 1);
  s.C.leftCols(n) = system.C * part->phi;
  s.C(0, n) = (system.C * part->held).sum() + direct - rising;
  s.D(0, 0) = rising;
  return result;
}

}  // namespace bodeflow::validation
