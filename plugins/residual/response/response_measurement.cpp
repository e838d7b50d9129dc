#include "response_measurement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "checked_response.hpp"
#include "line_statistics.hpp"
#include "model/simulate.hpp"
#include "records/checksum.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;
using records::ResponseData;

constexpr double kTwoPi = 6.283185307179586;
constexpr double kHighest = 1e-3;
constexpr double kLeak = 1e-4;
// The unit of errors relative to the magnitude: so small that what no model of a real plant explains is many of it.
constexpr double kRelative = 1e-3;

Complex axis(double frequency_hz) { return {0.0, kTwoPi * frequency_hz}; }

class ResponseMeasurement final : public Measurement {
 public:
  ResponseMeasurement(ResponseData data, const std::string& name, std::vector<double> known, const BaseModel& base)
      : data_(std::move(data)), timing_(base.timing()) {
    facts_.name = name;
    facts_.known = std::move(known);
    facts_.input_name = data_.input_names.front();
    facts_.output_name = data_.output_names.front();
    facts_.input_unit = "1";
    facts_.output_unit = data_.response_units.empty() ? "" : data_.response_units.front();
    if (data_.variance.size() == 0) facts_.error_unit = "%";
    facts_.samples = lines();
    if (!data_.input_amplitude.empty()) facts_.level = data_.input_amplitude.front();
    records::Checksum sum;
    sum.add({data_.frequency_hz.data(), static_cast<std::size_t>(lines())});
    for (Eigen::Index j = 0; j < inputs(); ++j)
      for (Eigen::Index k = 0; k < lines(); ++k) {
        const double parts[] = {data_.response(k, j).real(), data_.response(k, j).imag()};
        sum.add(parts);
      }
    facts_.checksum = sum.text();
    deviation_ =
        floor_known() ? Eigen::MatrixXd(data_.variance.cwiseSqrt()) : Eigen::MatrixXd(kRelative * data_.response.cwiseAbs());
  }

  const MeasurementFacts& facts() const override { return facts_; }
  bool floor_known() const override { return data_.variance.size() != 0; }
  Eigen::Index rows() const override { return 2 * lines() * inputs(); }

  Eigen::VectorXd residual(const JointModel& model, const Eigen::VectorXd& values) const override {
    const Eigen::MatrixXcd predicted = predicted_by(model, values);
    // A complex error of variance v has v / 2 in each part; relative ones count as they are.
    const double parts = floor_known() ? std::sqrt(2.0) : 1.0;
    Eigen::VectorXd r(rows());
    for (Eigen::Index j = 0; j < inputs(); ++j) {
      for (Eigen::Index k = 0; k < lines(); ++k) {
        const Complex e = parts * (data_.response(k, j) - predicted(k, j)) / deviation_(k, j);
        r.segment<2>(row(k, j)) << e.real(), e.imag();
      }
    }
    return r;
  }

  Eigen::Index eliminated(const JointModel&, const Eigen::VectorXd&) const override { return 0; }

  std::vector<ClassTest> tests(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                               const Eigen::MatrixXd& covariance, bool fitted) const override {
    if (!floor_known()) return {{"whiteness", 1.0, likeness_tail(residual, inputs())}};
    const Eigen::VectorXd r = fitted ? residual : whitened(residual, jacobian, covariance);
    const double lost = fitted ? (jacobian.transpose() * jacobian * covariance).trace() : 0.0;
    const double freedom = std::max(static_cast<double>(rows()) - lost, 1.0);
    std::vector<ClassTest> all = {{"excited", std::sqrt(r.squaredNorm() / freedom),
                                   lines_tail(r, freedom_of_variance(), lost, static_cast<double>(data_.correlated_lines))}};
    if (data_.correlated_lines == 0) all.push_back({"whiteness", all.front().multiple, likeness_tail(r, inputs())});
    return all;
  }

  Gain gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const override {
    const double squares_before = before.squaredNorm(), squares_after = after.squaredNorm(), count = static_cast<double>(rows());
    Gain g;
    if (floor_known()) {
      g.likelihood = (squares_before - squares_after) / (2.0 * static_cast<double>(data_.correlated_lines) + 1.0);
      g.excess_before = std::max(squares_before - count, 0.0);
      g.excess_after = std::max(squares_after - count, 0.0);
      return g;
    }
    const double independent = count / std::max(likeness_length(before, inputs()), likeness_length(after, inputs()));
    if (squares_before > 0.0 && squares_after > 0.0) g.likelihood = independent * std::log(squares_before / squares_after);
    g.block_z = block_deviate(before, after, inputs());
    g.excess_before = squares_before;
    g.excess_after = squares_after;
    return g;
  }

  HeldOutError error(const Eigen::VectorXd& residual) const override {
    HeldOutError h;
    const auto points = static_cast<double>(lines() * inputs());
    if (!floor_known()) {
      h.error = 100.0 * kRelative * std::sqrt(residual.squaredNorm() / points);  // in %
      return h;
    }
    double square = 0.0;
    for (Eigen::Index j = 0; j < inputs(); ++j)
      for (Eigen::Index k = 0; k < lines(); ++k)
        square += 0.5 * data_.variance(k, j) * residual.segment<2>(row(k, j)).squaredNorm();
    const double mean = data_.variance.sum(), shared = 2.0 * static_cast<double>(data_.correlated_lines) + 1.0;
    const double freedom = std::max(2.0 * mean * mean / data_.variance.squaredNorm() / shared, 1.0);
    h.error = std::sqrt(square / points);
    h.floor = std::sqrt(mean / points);
    h.highest = h.floor * std::sqrt(f_limit(kHighest, freedom, freedom * freedom_of_variance()));
    h.lowest = h.floor * std::sqrt(f_limit(1.0 - kLeak, freedom, freedom * freedom_of_variance()));
    return h;
  }

  ResidualPicture picture(const Eigen::VectorXd& residual) const override {
    ResidualPicture p;
    p.axis = "frequency";
    p.at = data_.frequency_hz;
    const double parts = floor_known() ? 2.0 : 1.0;
    p.measured = data_.response.rowwise().norm();
    p.residual.resize(lines());
    for (Eigen::Index k = 0; k < lines(); ++k) {
      double square = 0.0;
      for (Eigen::Index j = 0; j < inputs(); ++j)
        square += deviation_(k, j) * deviation_(k, j) * residual.segment<2>(row(k, j)).squaredNorm() / parts;
      p.residual[k] = std::sqrt(square);
    }
    if (floor_known()) p.noise = deviation_.rowwise().norm();
    p.kind.assign(static_cast<std::size_t>(lines()), 1);
    return p;
  }

  std::vector<ClassSize> class_sizes(const Eigen::VectorXd& residual) const override {
    if (!floor_known()) return {};
    const HeldOutError all = error(residual);
    return {{"excited", all.error, all.floor}};
  }

  std::vector<MeasuredResponse> response() const override {
    std::vector<MeasuredResponse> all;
    for (Eigen::Index j = 0; j < inputs(); ++j) {
      MeasuredResponse m;
      m.known = facts_.known;
      for (Eigen::Index k = 0; k < lines(); ++k) {
        m.frequency_hz.push_back(data_.frequency_hz[k]);
        m.response.push_back(data_.response(k, j) / path(data_.frequency_hz[k]));
        m.weight.push_back(1.0 / deviation_(k, j));
      }
      all.push_back(std::move(m));
    }
    return all;
  }

  void say(const JointModel& model, const Eigen::VectorXd& values, std::size_t place, Situation& s) const override {
    const Eigen::MatrixXcd predicted = predicted_by(model, values), missing = data_.response - predicted;
    const auto larger = [](double& x, double value) { x = std::isfinite(value) ? std::max(x, value) : x; };
    s.input_unit = facts_.input_unit;
    s.output_unit = facts_.output_unit;
    s.input_peak = s.input_rms = 1.0;
    const double root = std::sqrt(static_cast<double>(lines()));
    larger(s.output_peak, predicted.cwiseAbs().maxCoeff());
    larger(s.output_rms, predicted.norm() / root);
    larger(s.residual_rms, missing.norm() / root);
    const double relative =
        missing.cwiseQuotient(deviation_.cast<Complex>()).norm() / std::sqrt(static_cast<double>(missing.size()));
    s.line_hz.assign(data_.frequency_hz.begin(), data_.frequency_hz.end());
    s.response.clear(), s.missing.clear(), s.missing_std.clear();
    for (Eigen::Index k = 0; k < lines(); ++k) {
      s.response.push_back(predicted(k, 0));
      s.missing.push_back(missing(k, 0));
      s.missing_std.push_back(deviation_(k, 0) * (floor_known() ? 1.0 : relative));
    }
    if (place == Addition::kNoPlace) return;
    for (Eigen::Index k = 0; k < lines(); ++k) {
      const Complex at = axis(data_.frequency_hz[k]);
      const Eigen::MatrixXcd plant = plant_response(*model.base, values, facts_.known, at);
      const auto own = static_cast<Eigen::Index>(place) + 1;
      const double flow = plant.row(own).head(inputs()).norm(), output = plant.row(0).head(inputs()).norm();
      larger(s.place.flow, flow);
      larger(s.place.stored, flow / std::abs(at));
      // The reaction that alone makes the whole output.
      const double by_reaction = std::abs(plant(0, inputs() + own - 1));
      if (by_reaction > 0.0) larger(s.place.effort, output / by_reaction);
    }
  }

 private:
  Eigen::Index lines() const { return data_.frequency_hz.size(); }
  Eigen::Index inputs() const { return data_.inputs(); }
  Eigen::Index row(Eigen::Index line, Eigen::Index input) const { return 2 * (input * lines() + line); }
  double freedom_of_variance() const { return data_.degrees_of_freedom.value_or(std::numeric_limits<double>::infinity()); }
  bool held() const { return timing_.hold != Hold::band_limited; }

  /// The declared delay, and the hold in the middle of what it does.
  Complex path(double frequency_hz) const {
    const double half = held() ? std::numbers::pi * frequency_hz / *data_.sample_rate_hz : 0.0;
    const double fall = half > 0.0 ? std::sin(half) / half : 1.0;
    const bool straight = timing_.hold == Hold::first_order;
    return std::polar(straight ? fall * fall : fall, -(straight ? 0.0 : half) - kTwoPi * frequency_hz * timing_.delay_s);
  }

  Eigen::MatrixXcd predicted_by(const JointModel& model, const Eigen::VectorXd& values) const {
    if (!model.linear()) return Eigen::MatrixXcd::Constant(lines(), inputs(), std::numeric_limits<double>::quiet_NaN());
    Eigen::MatrixXcd g(lines(), inputs());
    for (Eigen::Index k = 0; k < lines(); ++k) {
      const double f = data_.frequency_hz[k];
      g.row(k) = held() ? sampled_response(model, values, facts_.known, f, 1.0 / *data_.sample_rate_hz)
                        : joint_response(model, values, facts_.known, axis(f));
    }
    return g;
  }

  /// (I + J C J')^-1/2 r: what of a residual that was not fitted the uncertain parameters do not explain.
  static Eigen::VectorXd whitened(const Eigen::VectorXd& r, const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& covariance) {
    // With C = L L' and (J L)' J L = V S V', (I + J C J')^-1/2 r = r + J L V ((1 + S)^-1/2 - 1) S^-1 V' (J L)' r.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> c(covariance);
    const Eigen::MatrixXd root = c.eigenvectors() * c.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal(),
                          spread = jacobian * root;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> inner(spread.transpose() * spread);
    const Eigen::VectorXd factor = inner.eigenvalues().unaryExpr([](double x) {
      const double t = std::sqrt(1.0 + std::max(x, 0.0));
      return -1.0 / (t * (1.0 + t));  // (1 / t - 1) / x without the difference of near numbers
    });
    const Eigen::VectorXd projected = inner.eigenvectors().transpose() * (spread.transpose() * r);
    return r + spread * (inner.eigenvectors() * factor.cwiseProduct(projected));
  }

  ResponseData data_;
  Timing timing_;
  MeasurementFacts facts_;
  Eigen::MatrixXd deviation_;  ///< of the complex values: their standard deviation, or kRelative of their magnitude
};

}  // namespace

Expected<std::shared_ptr<const Measurement>> response_measurement(const records::ResponseData& response, const std::string& name,
                                                                  std::vector<double> known, const BaseModel& base) {
  auto checked = checked_response(response, base);
  if (!checked) return tl::unexpected(checked.error());
  if (known.size() != base.known().size())
    return refused(std::to_string(known.size()) + " known values, the base model has " + std::to_string(base.known().size()));
  if (base.timing().hold != Hold::band_limited && !(checked->sample_rate_hz.value_or(0.0) > 0.0))
    return refused(
        "it states no sample rate, and the input of the base model is held over each sample; declare hold=band_limited, "
        "or measure the response with its rate");
  return std::make_shared<const ResponseMeasurement>(std::move(*checked), name, std::move(known), base);
}

}  // namespace bodeflow::residual
