#include "trace/coordinates.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

// Logarithms of what is still a number, and has a logarithm again.
constexpr double kFarthest = 600.0;

double coordinate(const FitParameter& p, double value) { return p.logarithmic ? std::log(value) : value / p.scale; }
double value_at(const FitParameter& p, double c) {
  return p.logarithmic ? std::exp(std::clamp(c, -kFarthest, kFarthest)) : c * p.scale;
}

}  // namespace

Coordinates::Coordinates(std::vector<FitParameter> parameters, std::size_t records)
    : parameters_(std::move(parameters)), records_(records) {
  for (const FitParameter& p : parameters_) place_.push_back(p.each_record ? own_++ : shared_++);
  logarithmic_.assign(static_cast<std::size_t>(size()), false);
  for (std::size_t p = 0; p < parameters_.size(); ++p)
    for (std::size_t r = 0; r < records_; ++r) logarithmic_[static_cast<std::size_t>(index(p, r))] = parameters_[p].logarithmic;
}

Eigen::Index Coordinates::index(std::size_t p, std::size_t record) const {
  return parameters_[p].each_record ? shared_ + own_ * static_cast<Eigen::Index>(record) + place_[p] : place_[p];
}

Eigen::VectorXd Coordinates::values(const Eigen::VectorXd& coordinates, std::size_t record) const {
  Eigen::VectorXd v(static_cast<Eigen::Index>(parameters_.size()));
  for (std::size_t p = 0; p < parameters_.size(); ++p)
    v[static_cast<Eigen::Index>(p)] = value_at(parameters_[p], coordinates[index(p, record)]);
  return v;
}

Eigen::VectorXd Coordinates::of(const Eigen::VectorXd& values) const {
  Eigen::VectorXd c(size());
  for (std::size_t r = 0; r < records_; ++r) put(values, r, c);
  return c;
}

void Coordinates::put(const Eigen::VectorXd& values, std::size_t record, Eigen::VectorXd& coordinates) const {
  for (std::size_t p = 0; p < parameters_.size(); ++p)
    coordinates[index(p, record)] = coordinate(parameters_[p], values[static_cast<Eigen::Index>(p)]);
}

Eigen::VectorXd Coordinates::slopes(const Eigen::VectorXd& values) const {
  Eigen::VectorXd s(values.size());
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    s[i] = parameters_[p].logarithmic ? values[i] : parameters_[p].scale;
  }
  return s;
}

std::string beyond(const FitParameter& p, double value, double tolerance) {
  const auto text = [&p](double bound) {
    return records::short_number(bound, 3) + (p.unit == "1" || p.unit.empty() ? "" : " " + p.unit);
  };
  if (!(value >= p.low - tolerance)) return "below " + text(p.low);
  if (!(value <= p.high + tolerance)) return "above " + text(p.high);
  return "";
}

}  // namespace bodeflow::residual
