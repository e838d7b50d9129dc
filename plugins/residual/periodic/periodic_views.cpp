#include "periodic/periodic_views.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "periodic/fourier.hpp"
#include "periodic/periodic_prediction.hpp"
#include "sampled/residual_looks.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kMostPlaces = 3;

/// The lines of the period among bins of the record.
template <class Vector>
Vector lines_of(const PeriodicRecord& r, const Vector& bins) {
  return bins(Eigen::seqN(Eigen::Index{0}, r.lines(), r.periods));
}

double weight(Eigen::Index bin) { return bin == 0 ? 1.0 : 2.0; }

MeanMap map_of(const PeriodicRecord& r, const Eigen::VectorXd& residual, const Eigen::VectorXd& variance,
               const Eigen::VectorXd& signal) {
  const std::vector<std::vector<Eigen::Index>> bins = bins_by_value(signal);
  const auto count = static_cast<Eigen::Index>(bins.size());
  MeanMap map{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index b = 0; b < count; ++b) {
    const std::vector<Eigen::Index>& rows = bins[static_cast<std::size_t>(b)];
    map.at[b] = signal(rows).mean();
    map.mean[b] = residual(rows).mean();
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(r.period);
    weights(rows).setConstant(1.0 / static_cast<double>(rows.size()));
    const Eigen::VectorXcd spectrum = coefficients(weights) * static_cast<double>(r.period);
    double square = 0.0;
    for (Eigen::Index k = 0; k < std::min(r.lines(), spectrum.size()); ++k)
      square += weight(k) * variance[k] * std::norm(spectrum[k]);
    map.std[b] = std::sqrt(square);
  }
  return map;
}

ResidualCourse course_of(const PeriodicRecord& r, const Eigen::VectorXcd& left) {
  const Eigen::VectorXd over_time = signal_of(left, r.period * r.periods);
  ResidualCourse course;
  course.axis = "period";
  course.at.resize(r.periods);
  course.rms.resize(r.periods);
  for (Eigen::Index p = 0; p < r.periods; ++p) {
    course.at[p] = static_cast<double>(p + 1);
    course.rms[p] = over_time.segment(p * r.period, r.period).norm() / std::sqrt(static_cast<double>(r.period));
  }
  course.noise = std::sqrt(r.variance[0] + 2.0 * r.variance.tail(r.bins() - 1).sum());
  return course;
}

Autocorrelation correlation_of(const PeriodicRecord& r, const Eigen::VectorXd& residual) {
  const Eigen::Index values = 2 * r.bins() - 1, lags = std::min(kViewedLags, values / 4);
  const double power = residual.squaredNorm();
  Autocorrelation a;
  if (lags < 1 || !(power > 0.0)) return a;
  Eigen::VectorXd own(r.bins());
  for (Eigen::Index l = 0; l < r.bins(); ++l) {
    const BinRows rows = rows_of(l);
    own[l] = residual.segment(rows.begin, rows.count).squaredNorm();
  }
  a.band = kBand95 / std::sqrt(static_cast<double>(values));
  a.lag_s.resize(lags);
  a.value.resize(lags);
  const double step_s = static_cast<double>(r.period * r.periods) * r.sample_time_s() / static_cast<double>(values);
  for (Eigen::Index lag = 1; lag <= lags; ++lag) {
    double sum = 0.0;
    for (Eigen::Index l = 0; l < r.bins(); ++l)
      sum += own[l] * std::cos(kTwoPi * static_cast<double>((l * lag) % values) / static_cast<double>(values));
    a.lag_s[lag - 1] = static_cast<double>(lag) * step_s;
    a.value[lag - 1] = sum / power;
  }
  return a;
}

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::dc:
      return "dc";
    case Kind::excited:
      return "excited";
    case Kind::odd:
      return "odd";
    case Kind::even:
      return "even";
    case Kind::skirt:
      return "skirts";
    case Kind::between:
      break;
  }
  return "between";
}

}  // namespace

std::vector<SeenOver> signals_of(const PeriodicRecord& r, const JointModel& model, const Eigen::VectorXd& values,
                                 const Eigen::VectorXcd& left) {
  Eigen::VectorXcd predicted = lines_of<Eigen::VectorXcd>(r, r.output - left), slope = predicted;
  for (Eigen::Index k = 0; k < r.lines(); ++k) slope[k] *= Complex(0.0, kTwoPi * static_cast<double>(k) * r.line_hz());
  std::vector<SeenOver> over = {{"input", r.input_unit, r.input.col(0)},
                                {"output", r.output_unit, signal_of(predicted, r.period)},
                                {"slope of the output", r.output_unit + "/s", signal_of(slope, r.period)}};
  const std::vector<Place> places = model.base->places();
  if (places.empty()) return over;
  const PeriodicPrediction p = predict(r, model, values, true);
  for (std::size_t n = 0; n < std::min(places.size(), kMostPlaces); ++n) {
    const auto column = static_cast<Eigen::Index>(n);
    if (p.flow.rows() != r.period || p.stored.rows() != r.period || p.flow.cols() <= column) break;
    over.push_back({"flow at " + places[n].name, places[n].flow_unit, p.flow.col(column)});
    over.push_back({"stored at " + places[n].name, places[n].stored_unit, p.stored.col(column)});
  }
  return over;
}

ResidualViews views_of(const PeriodicRecord& r, const Eigen::VectorXd& residual, const std::vector<SeenOver>& over) {
  const Eigen::VectorXcd left = unwhitened(r, residual);
  const Eigen::VectorXd period = signal_of(lines_of<Eigen::VectorXcd>(r, left), r.period);
  const Eigen::VectorXd variance = lines_of<Eigen::VectorXd>(r, r.variance);
  ResidualViews views;
  for (const SeenOver& signal : over) views.maps.push_back(map_of(r, period, variance, signal.values));
  views.course = course_of(r, left);
  views.autocorrelation = correlation_of(r, residual);
  return views;
}

std::vector<ClassSize> class_sizes(const PeriodicRecord& r, const Eigen::VectorXd& residual) {
  const Eigen::VectorXcd left = unwhitened(r, residual);
  std::vector<ClassSize> sizes;
  for (const Kind kind : {Kind::excited, Kind::odd, Kind::even, Kind::dc, Kind::skirt, Kind::between}) {
    double square = 0.0, noise = 0.0;
    for (Eigen::Index l = 0; l < r.bins(); ++l) {
      if (r.kind[static_cast<std::size_t>(l)] != kind) continue;
      square += weight(l) * std::norm(left[l]);
      noise += weight(l) * r.variance[l];
    }
    if (noise > 0.0) sizes.push_back({name_of(kind), std::sqrt(square), std::sqrt(noise)});
  }
  ClassSize peak{"peak", 0.0, 0.0};
  double highest = 0.0;
  for (Eigen::Index l = 0; l < r.bins(); ++l) {
    const Kind kind = r.kind[static_cast<std::size_t>(l)];
    const double over_noise = std::norm(left[l]) / r.variance[l];
    if ((kind != Kind::skirt && kind != Kind::between) || !(over_noise > highest)) continue;
    highest = over_noise;
    peak.rms = std::sqrt(weight(l)) * std::abs(left[l]);
    peak.noise = std::sqrt(weight(l) * r.variance[l]);
  }
  if (highest > 0.0) sizes.push_back(peak);
  return sizes;
}

}  // namespace bodeflow::residual
