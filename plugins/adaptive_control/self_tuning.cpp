#include "self_tuning.hpp"

#include <bodeflow/numerics/iir_design.hpp>
#include <cmath>

#include "householder.hpp"
#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

Coefficients coefficients_of(const Eigen::VectorXd& polynomial) {
  Coefficients c{};
  for (Eigen::Index i = 0; i < polynomial.size(); ++i) c[static_cast<std::size_t>(i)] = polynomial[i];
  return c;
}

}  // namespace

Expected<SelfTuningRegulator> SelfTuningRegulator::make(const SelfTuningSettings& s) {
  if (s.a_m.size() != 3 || s.a_o.size() != 3) return refused("the self-tuning regulator needs A_m and A_o of order 2");
  if (!(s.p0 > 0.0)) return refused("p0 " + text_of(s.p0) + "; allowed: above 0");
  if (!(s.forgetting > 0.0 && s.forgetting <= 1.0)) return refused("forgetting " + text_of(s.forgetting) + "; allowed: 0 to 1");
  const auto a_m = sampled_observer(s.a_m, s.sample_time), a_o = sampled_observer(s.a_o, s.sample_time);
  if (!a_m) return refused(a_m.error().text);
  if (!a_o) return refused(a_o.error().text);
  numerics::IirDesign design;
  design.pass = numerics::Pass::band;
  design.order = 2;
  design.edges = {s.band_low * s.sample_time, s.band_high * s.sample_time};
  const auto filter = numerics::design_iir(design);
  if (!filter) return refused("the data filter: " + filter.error().text);
  return SelfTuningRegulator(s, filter->sections, coefficients_of(*a_m), coefficients_of(*a_o));
}

SelfTuningRegulator::SelfTuningRegulator(const SelfTuningSettings& s, const numerics::Sections& filter, const Coefficients& a_m,
                                         const Coefficients& a_o)
    : settings_(s),
      filter_y_(filter),
      filter_u_(filter),
      a_m_(a_m),
      a_o_(a_o),
      estimator_(4, s.p0),
      controller_(s.least, s.most) {
  Rst degrees;
  degrees.n_r = degrees.n_s = degrees.n_t = 2;
  rst_ = proportional(s.start_gain, degrees);
}

double SelfTuningRegulator::step(double y, double u_c) {
  const double y_f = filter_y_.step(y), u_f = filter_u_.step(u_late_);
  u_past_[1] = u_past_[0];
  u_past_[0] = u_f;
  const Regressor phi{-y_past_[0], -y_past_[1], u_past_[0], u_past_[1]};
  const double error = y_f - estimator_.prediction(phi);
  estimator_.measure(phi, settings_.forgetting);
  estimator_.correct(error);
  y_past_[1] = y_past_[0];
  y_past_[0] = y_f;
  if (sample_ >= settings_.start && !design()) ++refused_;
  ++sample_;
  u_late_ = controller_.step(y, u_c, rst_, a_o_);
  return u_late_;
}

/// A (z - 1)(z + r) + B S = A_m A_o for r, s_0, s_1, s_2, by comparing z^3 .. z^0. False, and the last controller stays, where A
/// (z - 1) and B have a common factor.
bool SelfTuningRegulator::design() {
  const Regressor& theta = estimator_.theta();
  const double integrated[4] = {1.0, theta[0] - 1.0, theta[1] - theta[0], -theta[1]};  // A (z - 1)
  double wanted[5] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) wanted[i + k] += a_m_[i] * a_o_[k];
  }
  LeastSquaresRows<4, 4> rows(4, 4);
  for (int power = 0; power < 4; ++power) {  // row of z^(3 - power)
    const int next = power + 1;
    rows.at(power, 0) = integrated[power];
    for (int k = 0; k < 3; ++k) rows.at(power, 1 + k) = power == k ? theta[2] : power == k + 1 ? theta[3] : 0.0;
    rows.right_side(power) = wanted[next] - (next < 4 ? integrated[next] : 0.0);
  }
  double solution[4], residual = 0.0;
  const double gain = theta[2] + theta[3];  // B(1)
  if (!rows.solve(solution, residual) || !(std::abs(gain) > 1e-12)) return false;
  rst_.r = {1.0, solution[0] - 1.0, -solution[0]};
  rst_.s = {solution[1], solution[2], solution[3]};
  const double t0 = value_at(a_m_, 2, 1.0) / gain;
  for (std::size_t i = 0; i < 3; ++i) rst_.t[i] = t0 * a_o_[i];
  return true;
}

}  // namespace bodeflow::adaptive_control
