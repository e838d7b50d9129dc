#include "model/joint_model.hpp"

#include <algorithm>

namespace bodeflow::residual {

std::vector<FitParameter> JointModel::parameters() const {
  std::vector<FitParameter> all = base->parameters();
  for (const Addition& a : additions) all.insert(all.end(), a.parameters.begin(), a.parameters.end());
  return all;
}

Eigen::Index JointModel::base_count() const { return static_cast<Eigen::Index>(base->parameters().size()); }

Eigen::Index JointModel::begin_of(std::size_t a) const {
  Eigen::Index begin = base_count();
  for (std::size_t i = 0; i < a; ++i) begin += static_cast<Eigen::Index>(additions[i].parameters.size());
  return begin;
}

bool JointModel::has(Acts acts) const {
  return std::any_of(additions.begin(), additions.end(), [acts](const Addition& a) { return a.what.acts == acts; });
}

bool JointModel::linear() const { return !base->has_laws() && !has(Acts::law) && !has(Acts::input) && !has(Acts::output); }

bool JointModel::nonstationary() const {
  return std::any_of(additions.begin(), additions.end(), [](const Addition& a) { return a.what.nonstationary; });
}

double JointModel::delay_s(const Eigen::VectorXd& values) const {
  double sum = base->timing().delay_s;
  for (std::size_t a = 0; a < additions.size(); ++a)
    if (additions[a].what.acts == Acts::delay) sum += additions[a].effect->delay_s(values_of(a, values));
  return sum;
}

int JointModel::steps_per_sample() const {
  int most = 1;
  for (const Addition& a : additions) most = std::max(most, a.what.steps_per_sample);
  return most;
}

}  // namespace bodeflow::residual
