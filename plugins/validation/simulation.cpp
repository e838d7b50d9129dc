#include "simulation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <bodeflow/numerics/discretise.hpp>
#include <cmath>

#include "first_order_hold.hpp"
#include "records/signals.hpp"

namespace bodeflow::validation {
namespace {

constexpr double kSameTime = 1e-9;  ///< relative; sample times in files are decimal numbers

/// The output of the system at rest that the input drives, one sample an entry.
Eigen::VectorXd forced(const numerics::StateSpace& s, const Eigen::Ref<const Eigen::VectorXd>& u) {
  Eigen::VectorXd y(u.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(s.states(), 2);  // this sample's and the next one's, by turns
  for (Eigen::Index n = 0; n < u.size(); ++n) {
    const Eigen::Index now = n % 2, next = 1 - now;
    y[n] = s.D(0, 0) * u[n];
    if (s.states() == 0) continue;
    y[n] += s.C.row(0).dot(x.col(now));
    x.col(next).noalias() = s.A.lazyProduct(x.col(now));
    x.col(next) += s.B.col(0) * u[n];
  }
  return y;
}

}  // namespace

Expected<SampledModel> sampled_model(const records::ModelData& m, double sample_rate_hz, Hold hold) {
  const double time = 1.0 / sample_rate_hz;
  const numerics::TransferFunction g{m.numerator, m.denominator, m.sample_time_s};
  auto system = numerics::to_state_space(g);
  if (!system) return unexpected(system.error().text);
  SampledModel sampled;
  if (m.sample_time_s > 0.0) {
    if (std::abs(m.sample_time_s / time - 1.0) > kSameTime)
      return unexpected("its sample time is " + records::short_number(m.sample_time_s, 9) + " s, that of the data " +
                        records::short_number(time, 9) + " s; resample the data, or identify at this rate");
    const numerics::SplitDelay delay = numerics::split_delay(std::max(m.delay_s, 0.0), m.sample_time_s);
    if (delay.rest_s > 0.0 || m.delay_s < 0.0)
      return unexpected("its delay of " + records::short_number(m.delay_s) + " s is no whole number of samples");
    sampled.system = std::move(*system);
    sampled.delay = delay.samples;
  } else {
    auto held = hold == Hold::first_order ? first_order_hold(*system, time, m.delay_s)
                                          : numerics::zero_order_hold(*system, time, m.delay_s);
    if (!held) return unexpected(held.error().text);
    sampled.system = std::move(held->model);
    sampled.delay = held->delay;
  }
  if (sampled.system.states() > 0) sampled.largest_pole = sampled.system.A.eigenvalues().cwiseAbs().maxCoeff();
  return sampled;
}

Expected<Simulation> simulate(const SampledModel& model, const Eigen::VectorXd& input, const Eigen::VectorXd& output,
                              bool estimate_offset) {
  const Eigen::Index states = model.system.states(), unknowns = states + (estimate_offset ? 1 : 0);
  const Eigen::Index samples = output.size() - model.delay;
  if (samples < std::max<Eigen::Index>(3 * unknowns, 2))
    return unexpected("the data have " + records::counted(output.size(), "sample") + "; needed: at least " +
                      std::to_string(model.delay + std::max<Eigen::Index>(3 * unknowns, 2)) + " for its " +
                      records::counted(states, "state") + " and its delay of " + records::counted(model.delay, "sample"));
  Simulation s;
  s.first = model.delay;
  s.output = forced(model.system, input.head(samples));
  if (!s.output.allFinite()) return unexpected("its simulation grows beyond all bounds: it is unstable");

  // Free responses to the states, and the offset, side by side.
  Eigen::MatrixXd free(samples, unknowns);
  Eigen::RowVectorXd row = states > 0 ? Eigen::RowVectorXd(model.system.C.row(0)) : Eigen::RowVectorXd();
  for (Eigen::Index n = 0; n < samples; ++n) {
    free.row(n).head(states) = row;
    if (states > 0) row = row * model.system.A;
  }
  if (estimate_offset) free.col(states).setOnes();
  if (!free.allFinite()) return unexpected("its simulation grows beyond all bounds: it is unstable");
  Eigen::VectorXd found = Eigen::VectorXd::Zero(unknowns);
  if (unknowns > 0) {
    // A state that the output hardly shows, or an integrator's beside the offset: the shortest of the solutions.
    found = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(free).solve(output.tail(samples) - s.output);
    s.output += free * found;
  }
  s.initial_state = found.head(states);
  if (estimate_offset) s.offset = found[states];
  return s;
}

}  // namespace bodeflow::validation
