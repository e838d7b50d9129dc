#include "local_polynomial.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr Index kUsualDegreesOfFreedom = 7;
// Regressors of unit norm whose part of their own is below this are not told apart: beneath it lies the rounding of the spectra.
constexpr double kDependent = 1e-10;
// Beside the strongest line: below it there is only the rounding of the transform.
constexpr double kSilent = 1e-12;

/// One fit: A X = B over 2n + 1 lines.
class Fit {
 public:
  Fit(const RecordSpectra& s, const LocalPolynomial& settings)
      : spectra_(s),
        settings_(settings),
        driving_(s.reference.size() != 0 ? s.reference : s.input),
        closed_(s.reference.size() != 0),
        rows_(2 * settings.half_width + 1),
        highest_((s.samples - 1) / 2),
        a_(rows_, settings.unknowns(driving_.cols())),
        b_(rows_, s.output.cols() + (closed_ ? s.input.cols() : 0)),
        silent_(kSilent * driving_.bottomRows(driving_.rows() - 1).cwiseAbs().colwise().maxCoeff()) {}

  /// Solves at line k; false where the regressors depend on each other.
  bool solve(std::int64_t k) {
    first_ = std::clamp<std::int64_t>(k - settings_.half_width, 1, highest_ - rows_ + 1);
    fill(k);
    // A column's norm spans the decades of the excitation; scaled, the rank is that of the geometry.
    const Eigen::VectorXd norm = a_.colwise().norm();
    if (!(norm.minCoeff() > 0.0) || (norm.head(driving_.cols()).transpose().array() < silent_.array()).any()) return false;
    a_ = a_ * norm.cwiseInverse().asDiagonal();
    qr_.compute(a_);
    const auto diagonal = qr_.matrixR().diagonal().cwiseAbs();
    if (!(diagonal.minCoeff() > kDependent * diagonal.maxCoeff())) return false;
    const MatrixXcd weights = qr_.solve(MatrixXcd::Identity(rows_, rows_));  // pseudo-inverse: unknowns x lines
    solution_ = weights * b_;
    residual_ = b_ - a_ * solution_;
    solution_ = norm.cwiseInverse().asDiagonal() * solution_;
    const Index inputs = driving_.cols();
    weights_ = norm.head(inputs).cwiseInverse().asDiagonal() * weights.topRows(inputs);
    return closed_ ? divide() : true;
  }

  /// G(k) transposed: inputs x outputs.
  MatrixXcd response() const { return solution_.topLeftCorner(driving_.cols(), spectra_.output.cols()); }
  /// Squared norm of the weights of the lines in G_ij, by j.
  Eigen::VectorXd gain() const { return weights_.rowwise().squaredNorm(); }
  /// Noise power, by output.
  Eigen::RowVectorXd noise() const {
    const auto nu = static_cast<double>(settings_.degrees_of_freedom(driving_.cols()));
    return residual_.leftCols(spectra_.output.cols()).colwise().squaredNorm() / nu;
  }
  Eigen::RowVectorXd transient() const { return solution_.row(driving_.cols()).head(spectra_.output.cols()).cwiseAbs(); }
  double input_ratio() const { return input_ratio_; }

 private:
  /// Columns: G of order 0 for each input, T of order 0, then the higher orders; powers of r / n keep them of one size.
  void fill(std::int64_t k) {
    const Index inputs = driving_.cols();
    const double scale = 1.0 / static_cast<double>(std::max<Index>(1, settings_.half_width));
    const Index stride = inputs + (settings_.transient ? 1 : 0);
    for (Index row = 0; row < rows_; ++row) {
      const Index line = first_ + row;
      const double r = static_cast<double>(line - k) * scale;
      double power = 1.0;
      for (Index s = 0; s <= settings_.order; ++s, power *= r) {
        for (Index j = 0; j < inputs; ++j) a_(row, s * stride + j) = power * driving_(line, j);
        if (settings_.transient) a_(row, s * stride + inputs) = power;
      }
      b_.row(row).head(spectra_.output.cols()) = spectra_.output.row(line);
      if (closed_) b_.row(row).tail(spectra_.input.cols()) = spectra_.input.row(line);
    }
  }

  /// From [G_yr, G_ur] to G = G_yr G_ur^-1; all are transposed here.
  bool divide() {
    const Index inputs = driving_.cols(), outputs = spectra_.output.cols();
    const MatrixXcd ur = solution_.topRows(inputs).rightCols(inputs);
    const auto nu = static_cast<double>(settings_.degrees_of_freedom(inputs));
    const Eigen::RowVectorXd input_noise = residual_.rightCols(inputs).colwise().squaredNorm() / nu;
    const MatrixXd variance = weights_.rowwise().squaredNorm() * input_noise;
    const Eigen::ColPivHouseholderQR<MatrixXcd> factor(ur);
    const auto diagonal = factor.matrixR().diagonal().cwiseAbs();
    if (!(diagonal.minCoeff() > kDependent * diagonal.maxCoeff())) return false;
    // The weakest direction of the inputs beside the noise that G_ur has.
    input_ratio_ = diagonal.minCoeff() * diagonal.minCoeff() / variance.sum();
    const MatrixXcd g = factor.solve(solution_.topRows(inputs).leftCols(outputs));
    if (settings_.transient) solution_.row(inputs).head(outputs) -= solution_.row(inputs).tail(inputs) * g;
    solution_.topLeftCorner(inputs, outputs) = g;
    residual_.leftCols(outputs) -= residual_.rightCols(inputs) * g;
    weights_ = factor.solve(weights_);
    return true;
  }

  const RecordSpectra& spectra_;
  LocalPolynomial settings_;
  const MatrixXcd& driving_;
  bool closed_;
  Index rows_;
  std::int64_t highest_;
  std::int64_t first_ = 1;
  MatrixXcd a_, b_;
  Eigen::RowVectorXd silent_;  // norm of an input over a fit, by input
  MatrixXcd solution_, residual_, weights_;
  Eigen::ColPivHouseholderQR<MatrixXcd> qr_;
  double input_ratio_ = std::numeric_limits<double>::infinity();
};

void shorten(LocalPolynomialEstimate& e) {
  const auto rows = static_cast<Index>(e.lines.size());
  e.response.conservativeResize(rows, Eigen::NoChange);
  for (MatrixXd* m : {&e.variance, &e.noise_level, &e.transient_level}) {
    if (m->size() != 0) m->conservativeResize(rows, Eigen::NoChange);
  }
}

}  // namespace

Index usual_half_width(const LocalPolynomial& settings, Index inputs) {
  return (settings.unknowns(inputs) + kUsualDegreesOfFreedom) / 2;
}

Expected<LocalPolynomialEstimate> local_polynomial(const RecordSpectra& s, const std::vector<std::int64_t>& lines,
                                                   const LocalPolynomial& settings) {
  const Index inputs = s.input.cols(), outputs = s.output.cols(), width = 2 * settings.half_width + 1;
  const Index nu = settings.degrees_of_freedom(inputs);
  if (nu < 1)
    return unexpected("half_width " + std::to_string(settings.half_width) + " gives " + std::to_string(width) + " lines for " +
                      std::to_string(settings.unknowns(inputs)) + " unknowns; needed: at least one line more");
  if ((s.samples - 1) / 2 < width)
    return unexpected(counted(s.samples, "sample") + " give " + counted((s.samples - 1) / 2, "line") + "; a fit takes " +
                      std::to_string(width));
  if (!s.input.allFinite() || !s.output.allFinite() || !s.reference.allFinite())
    return unexpected("the values are too large to be transformed");

  LocalPolynomialEstimate e;
  e.degrees_of_freedom = static_cast<double>(nu);
  e.least_input_ratio = std::numeric_limits<double>::infinity();
  const auto most = static_cast<Index>(lines.size());
  e.response.resize(most, outputs * inputs);
  e.variance.resize(most, outputs * inputs);
  e.noise_level.resize(most, outputs);
  if (settings.transient) e.transient_level.resize(most, outputs);
  Fit fit(s, settings);
  for (const std::int64_t k : lines) {
    if (!fit.solve(k)) {
      e.silent_lines.push_back(k);
      continue;
    }
    const auto row = static_cast<Index>(e.lines.size());
    const MatrixXcd g = fit.response();
    const Eigen::VectorXd gain = fit.gain();
    const Eigen::RowVectorXd noise = fit.noise();
    for (Index i = 0; i < outputs; ++i) {
      for (Index j = 0; j < inputs; ++j) {
        e.response(row, i * inputs + j) = g(j, i);
        e.variance(row, i * inputs + j) = noise[i] * gain[j];
      }
    }
    if (!e.response.row(row).allFinite() || !e.variance.row(row).allFinite())
      return unexpected("line " + std::to_string(k) + ": the values are too large");
    e.noise_level.row(row) = noise.cwiseSqrt();
    if (settings.transient) e.transient_level.row(row) = fit.transient();
    e.least_input_ratio = std::min(e.least_input_ratio, fit.input_ratio());
    e.lines.push_back(k);
  }
  if (e.lines.empty()) return unexpected("the input excites none of the lines enough to estimate a response");
  shorten(e);
  return e;
}

}  // namespace bodeflow::spectrum
