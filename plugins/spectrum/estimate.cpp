#include "estimate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "line_response.hpp"

namespace bodeflow::spectrum {
namespace {

// The transform rounds at about 1e-16 of the strongest line times a few; what is below this is no signal.
constexpr double kRounding = 1e-12;

/// Row-major values of an outputs x inputs matrix.
template <class Matrix>
auto as_row(const Matrix& m) {
  using Row = Eigen::Matrix<typename Matrix::Scalar, 1, Eigen::Dynamic>;
  Row row(m.size());
  for (Eigen::Index i = 0; i < m.rows(); ++i) row.segment(i * m.cols(), m.cols()) = m.row(i);
  return row;
}

/// The robust method at one line: the mean over realisations, its scatter and the noise in it.
struct Robust {
  Eigen::MatrixXcd response;
  Eigen::MatrixXd variance, noise;
  double condition = 1.0;
};

Expected<Robust> over_realisations(const Measured& measured, Eigen::Index k, Form form) {
  const Layout& l = measured.layout;
  const std::size_t realisations = measured.realisations();
  const auto count = static_cast<double>(realisations);
  std::vector<LineResponse> each(realisations);
  Robust r;
  if (form == Form::reference) {
    std::vector<FromReference> from(realisations);
    Eigen::MatrixXcd mean = Eigen::MatrixXcd::Zero(l.signals(), l.references);
    for (std::size_t m = 0; m < realisations; ++m) {
      auto reference = from_reference(measured, m, k);
      if (!reference) return unexpected(reference.error().text);
      from[m] = std::move(*reference);
      mean += from[m].transfer / count;
      r.condition = std::max(r.condition, from[m].condition);
    }
    const Eigen::MatrixXcd inverse = mean.topRows(l.inputs).inverse();
    r.response = mean.middleRows(l.inputs, l.outputs) * inverse;
    for (std::size_t m = 0; m < realisations; ++m) {
      // The deviation (T_y - G T_u) T_u^-1 takes the place of G^m - G.
      each[m].weights = from[m].weights * inverse;
      each[m].response = r.response;
      add_variance(each[m], measured, m, k, form);
      each[m].response +=
          (from[m].transfer.middleRows(l.inputs, l.outputs) - r.response * from[m].transfer.topRows(l.inputs)) * inverse;
    }
  } else {
    r.response = Eigen::MatrixXcd::Zero(l.outputs, l.inputs);
    for (std::size_t m = 0; m < realisations; ++m) {
      auto at = line_response(measured, m, k, form);
      if (!at) return unexpected(at.error().text);
      each[m] = std::move(*at);
      r.response += each[m].response / count;
      r.condition = std::max(r.condition, each[m].condition);
    }
  }
  r.variance = Eigen::MatrixXd::Zero(l.outputs, l.inputs);
  for (const LineResponse& at : each) r.variance += (at.response - r.response).cwiseAbs2() / (count * (count - 1.0));
  if (!measured.has_noise()) return r;
  r.noise = Eigen::MatrixXd::Zero(l.outputs, l.inputs);
  for (const LineResponse& at : each) r.noise += at.variance / (count * count);
  return r;
}

void resize(Estimate& e, const Measured& measured, bool robust) {
  const auto lines = static_cast<Eigen::Index>(e.lines.size());
  const Eigen::Index outputs = measured.layout.outputs, entries = outputs * measured.layout.inputs;
  e.response.resize(lines, entries);
  e.variance.resize(lines, entries);
  e.degrees_of_freedom.resize(lines, entries);
  e.condition.resize(lines);
  if (measured.has_noise()) e.noise_level = Eigen::MatrixXd::Zero(lines, outputs);
  if (robust && measured.has_noise()) {
    e.noise_variance.resize(lines, entries);
    e.nonlinear_variance.resize(lines, entries);
  }
  if (measured.parts.size() > 1 || measured.layout.inputs > 1) return;
  e.input_mean.resize(lines);
  e.input_variance.resize(lines);
  e.output_mean.resize(lines, outputs);
  e.cross_covariance.resize(lines, outputs);
  e.output_variance.resize(lines, outputs);
}

/// Means, variances and noise levels of the signals themselves.
void take_signals(Estimate& e, const Measured& measured, Eigen::Index row, Eigen::Index k) {
  const Layout& l = measured.layout;
  if (!measured.has_noise()) return;
  for (const Moments& m : measured.parts) {
    e.noise_level.row(row) += m.variance.row(k).segment(l.inputs, l.outputs) / static_cast<double>(measured.parts.size());
  }
  e.noise_level.row(row) = e.noise_level.row(row).cwiseSqrt();
  if (e.input_mean.size() == 0) return;
  const Moments& m = measured.parts.front();
  e.input_mean[row] = m.mean(k, 0);
  e.input_variance[row] = m.variance(k, 0);
  for (Eigen::Index i = 0; i < l.outputs; ++i) {
    e.output_mean(row, i) = m.mean(k, 1 + i);
    e.output_variance(row, i) = m.variance(k, 1 + i);
    e.cross_covariance(row, i) = m.covariance(k, pair_column(1 + i, 0));
  }
}

Expected<void> take_response(Estimate& e, const Measured& measured, Eigen::Index row, Eigen::Index k, Form form) {
  const std::size_t realisations = measured.realisations();
  if (realisations == 1) {
    auto at = line_response(measured, 0, k, form);
    if (!at) return unexpected(at.error().text);
    e.response.row(row) = as_row(at->response);
    e.variance.row(row) = as_row(at->variance);
    e.degrees_of_freedom.row(row) = as_row(at->degrees_of_freedom);
    e.condition[row] = at->condition;
  } else {
    auto at = over_realisations(measured, k, form);
    if (!at) return unexpected(at.error().text);
    const auto count = static_cast<double>(realisations);
    e.response.row(row) = as_row(at->response);
    e.variance.row(row) = as_row(at->variance);
    e.degrees_of_freedom.row(row).setConstant(count - 1.0);
    e.condition[row] = at->condition;
    if (measured.has_noise()) {
      e.noise_variance.row(row) = as_row(at->noise);
      e.nonlinear_variance.row(row) = count * (e.variance.row(row) - e.noise_variance.row(row)).cwiseMax(0.0);
    }
  }
  if (!e.variance.row(row).allFinite() || !e.response.row(row).allFinite())
    return unexpected("line " + std::to_string(k) + ": the values are too large to be averaged");
  return {};
}

Expected<void> require_excited(const Measured& measured, const std::vector<std::int64_t>& lines, Form form) {
  for (std::size_t m = 0; m < measured.realisations(); ++m) {
    const Excitation x = excitation_of(measured, m);
    const double strongest = std::sqrt(x.power.tail(x.power.size() - 1).maxCoeff());
    for (const std::int64_t k : lines) {
      if (std::sqrt(x.power[k]) > kRounding * strongest) continue;
      const std::string what = form == Form::reference ? "reference" : "input";
      return unexpected("line " + std::to_string(k) + " of the " + what + " is not excited");
    }
  }
  return {};
}

}  // namespace

Expected<Estimate> estimate_response(const Measured& measured, const LineChoice& choice, Form form) {
  const bool robust = measured.realisations() > 1;
  Estimate e;
  e.realisations = static_cast<std::int64_t>(measured.realisations());
  e.periods = std::numeric_limits<std::int64_t>::max();
  for (const Moments& m : measured.parts) e.periods = std::min(e.periods, m.periods);
  if (!robust && !measured.has_noise()) {
    return unexpected("the variance needs at least 2 periods; found " + std::to_string(e.periods));
  }
  e.lines = chosen_lines(measured, choice);
  if (e.lines.empty())
    return unexpected("no line of the input stands out from its noise: is the input excited with this period?");
  if (auto excited = require_excited(measured, e.lines, form); !excited) return unexpected(excited.error().text);
  resize(e, measured, robust);
  for (Eigen::Index row = 0; row < e.response.rows(); ++row) {
    const auto k = static_cast<Eigen::Index>(e.lines[static_cast<std::size_t>(row)]);
    if (auto taken = take_response(e, measured, row, k, form); !taken) return unexpected(taken.error().text);
    take_signals(e, measured, row, k);
  }
  return e;
}

}  // namespace bodeflow::spectrum
