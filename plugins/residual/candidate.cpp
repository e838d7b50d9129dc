#include "candidate.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "records/signals.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

using records::short_number;

/// The first parameter of the effect that is beyond its bounds, in words; "" where all are inside.
std::string unphysical(const Effect& effect, const Fit& fit) {
  const std::vector<Parameter> parameters = effect.parameters();
  const Eigen::Index first = fit.values.size() - static_cast<Eigen::Index>(parameters.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string where = beyond(parameters[i], fit.values[first + static_cast<Eigen::Index>(i)]);
    if (!where.empty()) return parameters[i].name + " would be " + where;
  }
  return "";
}

/// The part of the excess over the noise on the selecting record that is gone.
double share_removed(const Examined& before, const Examined& after) {
  const double was = before.select_chi2 - static_cast<double>(before.select_residual.size());
  return was > 0.0 ? std::clamp((before.select_chi2 - after.select_chi2) / was, 0.0, 1.0) : 0.0;
}

std::string judged(const Candidate& c, const Levels& levels) {
  if (!(c.p < levels.p_candidate)) {
    return "improves the fit no more than chance does: p = " + short_number(c.p, 2) + ", needed below " +
           short_number(levels.p_candidate, 2);
  }
  if (const std::string where = unphysical(*c.effect, c.with.fit); !where.empty()) return "not physical: " + where;
  if (!(c.select_gain > levels.select_gain)) {
    return "does not help on the record that was not fitted: chi2 falls by " + short_number(c.select_gain, 3) +
           ", needed above " + short_number(levels.select_gain, 3);
  }
  return "";
}

}  // namespace

double Examined::smallest_p() const {
  double least = 1.0;
  for (const RecordTests& record : tests)
    for (const ClassTest& test : record.classes) least = std::min(least, test.p);
  return least;
}

std::size_t Examined::test_count() const {
  std::size_t count = 0;
  for (const RecordTests& record : tests) count += record.classes.size();
  return count;
}

Examined examine(Fit fit, std::span<const Experiment> fitted, const Experiment& select) {
  Examined x;
  x.fit = std::move(fit);
  for (const Experiment& e : fitted)
    x.tests.push_back({e.name, test_classes(e, predict(x.fit, e), x.fit.coordinate_covariance, true)});
  const Prediction selecting = predict(x.fit, select);
  x.tests.push_back({select.name, test_classes(select, selecting, x.fit.coordinate_covariance, false)});
  x.select_residual = selecting.residual;
  x.select_chi2 = selecting.residual.squaredNorm();
  return x;
}

Levels Levels::of(double alpha, double share, std::size_t class_tests, std::size_t candidates) {
  Levels l;
  l.alpha = alpha;
  l.share = share;
  l.p_class = alpha / 2.0 / static_cast<double>(std::max<std::size_t>(class_tests, 1));
  l.p_candidate = alpha / 2.0 / static_cast<double>(std::max<std::size_t>(candidates, 1));
  const double z = normal_limit(l.p_candidate);
  l.select_gain = z * z;
  return l;
}

double Candidate::merit() const { return select_gain - 2.0 * static_cast<double>(effect->parameters().size()); }

Candidate try_effect(const Effect& effect, const Examined& base, const std::vector<Eigen::VectorXd>& base_starts,
                     const Scales& scales, std::span<const Experiment> fitted, const Experiment& select, const Levels& levels) {
  Candidate c;
  c.name = effect.name();
  c.effect = &effect;
  c.with.fit.model = base.fit.model;
  JointModel model = base.fit.model;
  model.effects.push_back(&effect);
  std::vector<Eigen::VectorXd> starts;
  std::vector<Eigen::VectorXd> from = base_starts;
  from.push_back(base.fit.values);
  for (const Eigen::VectorXd& values : from) {
    for (const Eigen::VectorXd& own : effect.starts(scales)) {
      Eigen::VectorXd start(values.size() + own.size());
      start << values, own;
      starts.push_back(std::move(start));
    }
  }
  auto fitted_model = fit(model, fitted, starts);
  if (!fitted_model) {
    c.reason = "could not be fitted: " + fitted_model.error().text;
    return c;
  }
  c.with = examine(std::move(*fitted_model), fitted, select);
  c.fit_gain = base.fit.chi2 - c.with.fit.chi2;
  c.p = numerics::chi_squared_tail(c.fit_gain, static_cast<double>(effect.parameters().size()));
  c.select_gain = base.select_chi2 - c.with.select_chi2;
  c.share = share_removed(base, c.with);
  c.reason = judged(c, levels);
  c.accepted = c.reason.empty();
  c.explains = c.accepted && (c.share > levels.share || c.with.smallest_p() > levels.p_class);
  if (c.accepted && !c.explains) {
    c.reason = "explains only " + short_number(100.0 * c.share, 3) + " % of what is missing, needed above " +
               short_number(100.0 * levels.share, 3) + " %, and what it leaves is not noise";
  }
  return c;
}

double distinction(const Examined& better, const Examined& other) {
  const Eigen::VectorXd d = other.select_residual.cwiseAbs2() - better.select_residual.cwiseAbs2();
  const double std = std::sqrt((d.array() - d.mean()).square().sum());
  return std > 0.0 ? d.sum() / std : 0.0;
}

}  // namespace bodeflow::residual
