#include "model/step_maps.hpp"

#include <Eigen/Dense>

namespace bodeflow::residual {
namespace {

// Of a rough law: above 1/2 it damps what the trapezoidal rule leaves ringing.
constexpr double kTheta = 0.6;

/// What x at a time within a step is made of, and the weights of input and reactions at that time.
struct Instant {
  Eigen::MatrixXd x, u0, u1, w[3];  ///< of the state; columns: states, inputs, active places
  double at_u0 = 1.0, at_u1 = 0.0;
  double at_w[3] = {1.0, 0.0, 0.0};
};

Eigen::MatrixXd active_columns(const Eigen::MatrixXd& all, const Laws& laws) {
  Eigen::MatrixXd some(all.rows(), static_cast<Eigen::Index>(laws.count()));
  for (std::size_t i = 0; i < laws.count(); ++i)
    some.col(static_cast<Eigen::Index>(i)) = all.col(static_cast<Eigen::Index>(laws.place(i)));
  return some;
}

Eigen::MatrixXd active_rows(const Eigen::MatrixXd& all, const Laws& laws) {
  Eigen::MatrixXd some(static_cast<Eigen::Index>(laws.count()), all.cols());
  for (std::size_t i = 0; i < laws.count(); ++i)
    some.row(static_cast<Eigen::Index>(i)) = all.row(static_cast<Eigen::Index>(laws.place(i)));
  return some;
}

void set_inputs(const StepPlan& plan, const Transition& t, double h, Instant& now) {
  const Eigen::MatrixXd& B = plan.plant->B;
  now.x = t.phi;
  if (plan.push == Push::held) {
    now.u0.noalias() = t.psi[0] * B;
    return;
  }
  now.u1.noalias() = t.psi[1] * B / h;
  now.u0.noalias() = t.psi[0] * B;
  now.u0 -= now.u1;
  now.at_u1 = t.h / h;
  now.at_u0 = 1.0 - now.at_u1;
}

/// After t.h of a double step of h.
Instant of_double(const StepPlan& plan, const Transition& t, double h) {
  Instant now;
  set_inputs(plan, t, h, now);
  const Eigen::MatrixXd E = active_columns(plan.plant->E, *plan.laws);
  const Eigen::MatrixXd p0 = t.psi[0] * E, p1 = t.psi[1] * E / h, p2 = t.psi[2] * E / (h * h);
  now.w[0] = p0 - 3.0 * p1 + 2.0 * p2;
  now.w[1] = 4.0 * (p1 - p2);
  now.w[2] = 2.0 * p2 - p1;
  const double s = t.h / h;
  now.at_w[0] = (1.0 - s) * (1.0 - 2.0 * s);
  now.at_w[1] = 4.0 * s * (1.0 - s);
  now.at_w[2] = s * (2.0 * s - 1.0);
  return now;
}

/// After t.h of a single step of h.
Instant of_single(const StepPlan& plan, const Transition& t, double h) {
  Instant now;
  set_inputs(plan, t, h, now);
  const Eigen::MatrixXd E = active_columns(plan.plant->E, *plan.laws);
  const Eigen::MatrixXd p0 = t.psi[0] * E, p1 = t.psi[1] * E / h;
  now.w[0] = p0 - p1;
  now.w[1] = p1;
  for (std::size_t i = 0; i < plan.laws->count(); ++i) {
    if (!plan.laws->rough(i)) continue;
    const auto c = static_cast<Eigen::Index>(i);
    now.w[0].col(c) = (1.0 - kTheta) * p0.col(c);
    now.w[1].col(c) = kTheta * p0.col(c);
  }
  now.at_w[1] = t.h / h;
  now.at_w[0] = 1.0 - now.at_w[1];
  return now;
}

void put(const Eigen::MatrixXd& block, int row, int column, SmallMatrix& into) {
  for (Eigen::Index r = 0; r < block.rows(); ++r)
    for (Eigen::Index c = 0; c < block.cols(); ++c)
      into.at(row + static_cast<int>(r), column + static_cast<int>(c)) = block(r, c);
}

/// Fills rows of `known` and `unknown` with c x + d u + f w at that instant.
struct Writer {
  const StepPlan& plan;
  int nodes = 1;  ///< unknown ones
  SmallMatrix *known = nullptr, *unknown = nullptr;

  void operator()(const Instant& now, const Eigen::MatrixXd& c, const Eigen::MatrixXd& d, const Eigen::MatrixXd& f,
                  int row) const {
    int column = 0;
    const auto next = [&](const Eigen::MatrixXd& block) {
      put(block, row, column, *known);
      column += static_cast<int>(block.cols());
    };
    next(c * now.x);
    next(c * now.u0 + now.at_u0 * d);
    if (plan.push == Push::straight) next(c * now.u1 + now.at_u1 * d);
    next(c * now.w[0] + now.at_w[0] * f);
    for (int k = 0; k < nodes; ++k)
      put(c * now.w[k + 1] + now.at_w[k + 1] * f, row, k * static_cast<int>(plan.laws->count()), *unknown);
  }
};

template <class At>
StepMaps maps(const StepPlan& plan, const std::vector<Instant>& nodes, double h, double sample_s, const At& instant_at) {
  const PlantMatrices& p = *plan.plant;
  const int n = static_cast<int>(p.states()), q = static_cast<int>(p.inputs()), k = static_cast<int>(plan.laws->count());
  const int count = static_cast<int>(nodes.size()), all = static_cast<int>(p.places());
  const int columns = n + (plan.push == Push::straight ? 2 : 1) * q + k, rows = n + 2 * k * count;
  StepMaps s;
  s.h = h;
  s.known = SmallMatrix(rows, columns);
  s.unknown = SmallMatrix(rows, k * count);
  const Writer write{plan, count, &s.known, &s.unknown};
  write(nodes.back(), Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, q), Eigen::MatrixXd::Zero(n, k), 2 * k * count);
  const Eigen::MatrixXd cf = active_rows(p.Cf, *plan.laws), df = active_rows(p.Df, *plan.laws),
                        ff = active_columns(active_rows(p.Ff, *plan.laws), *plan.laws);
  const Eigen::MatrixXd cs = active_rows(p.Cs, *plan.laws), ds = active_rows(p.Ds, *plan.laws),
                        fs = active_columns(active_rows(p.Fs, *plan.laws), *plan.laws);
  for (int i = 0; i < count; ++i) {
    write(nodes[static_cast<std::size_t>(i)], cf, df, ff, 2 * k * i);
    write(nodes[static_cast<std::size_t>(i)], cs, ds, fs, 2 * k * i + k);
  }
  for (int place = 0; place < k; ++place)
    for (int r = 0; r < 2 * count; ++r)
      for (int c = 0; c < k * count; ++c) s.gains.push_back(s.unknown.at(r * k + place, c));
  s.sample_s = sample_s;
  if (sample_s < 0.0) return s;
  const int sampled = 1 + (plan.signals ? 2 * all : 0);
  s.sample_known = SmallMatrix(sampled, columns);
  s.sample_unknown = SmallMatrix(sampled, k * count);
  const Writer sample{plan, count, &s.sample_known, &s.sample_unknown};
  const Instant now = instant_at(transition(p.A, sample_s));
  sample(now, p.C, p.D, active_columns(p.F, *plan.laws), 0);
  if (!plan.signals) return s;
  sample(now, p.Cf, p.Df, active_columns(p.Ff, *plan.laws), 1);
  sample(now, p.Cs, p.Ds, active_columns(p.Fs, *plan.laws), 1 + all);
  return s;
}

}  // namespace

StepMaps double_step(const StepPlan& plan, const Transition& half, double sample_s) {
  const Transition whole = half.doubled();
  const double h = whole.h;
  return maps(plan, {of_double(plan, half, h), of_double(plan, whole, h)}, h, sample_s,
              [&](const Transition& t) { return of_double(plan, t, h); });
}

StepMaps single_step(const StepPlan& plan, const Transition& step, double sample_s) {
  return maps(plan, {of_single(plan, step, step.h)}, step.h, sample_s,
              [&](const Transition& t) { return of_single(plan, t, step.h); });
}

}  // namespace bodeflow::residual
