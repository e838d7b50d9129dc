#include "estimator_bank.hpp"

#include <cmath>

#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {

const char* name_of(Net net) {
  switch (net) {
    case Net::excitation:
      return "excitation gate";
    case Net::covariance:
      return "covariance bound";
    case Net::huber:
      return "residual clipping";
    case Net::ladder:
      return "bandwidth ladder";
    case Net::kept:
      return "last controller kept";
    case Net::rate:
      return "rate limit";
    case Net::retreat:
      return "retreat";
  }
  return "";
}

Expected<EstimatorBank> EstimatorBank::make(const BankSettings& s) {
  if (s.omega.empty()) return refused("no frequencies of fitting; needed: at least one");
  if (s.delays.size() != 1 && s.delays.size() != s.omega.size()) {
    return refused(std::to_string(s.delays.size()) + " delays for " + std::to_string(s.omega.size()) +
                   " frequencies; allowed: one for all, or one each");
  }
  for (const auto& [scale, name] : {std::pair(s.input_scale, "input_scale"), std::pair(s.output_scale, "output_scale")}) {
    if (!(scale > 0.0 && std::isfinite(scale))) return refused(std::string(name) + " " + text_of(scale) + "; allowed: above 0");
  }
  EstimatorBank bank;
  for (std::size_t j = 0; j < s.omega.size(); ++j) {
    FrequencyPointSettings point = s.point;
    point.omega = s.omega[j];
    point.delay = s.delays[s.delays.size() == 1 ? 0 : j];
    auto made = FrequencyPoint::make(point);
    if (!made) return refused(made.error().text);
    bank.points_.push_back(*made);
  }
  bank.nets_.resize(s.omega.size());
  bank.response_.resize(s.omega.size());
  bank.input_scale_ = s.input_scale;
  bank.output_scale_ = s.output_scale;
  bank.share_ = s.excitation_share;
  bank.floor_ = s.excitation_floor;
  return bank;
}

void EstimatorBank::step(double y, double u_late, double reference) {
  const double u = u_late / input_scale_;
  lowest_ = std::min(lowest_, u);
  highest_ = std::max(highest_, u);
  const double swing = 0.5 * share_ * (highest_ - lowest_);
  const double least = std::max(floor_, swing * swing);
  const FrequencyPoint::Sample sample{y / output_scale_, u, reference / output_scale_, least};
  for (std::size_t j = 0; j < points_.size(); ++j) {
    points_[j].step(sample);
    response_[j] = points_[j].response() * (output_scale_ / input_scale_);
    watch(j, least);
  }
  ++sample_;
}

double EstimatorBank::variance(int j) const {
  const double scale = output_scale_ / input_scale_;
  return point(j).variance() * scale * scale;
}

std::int64_t EstimatorBank::acted(Net net, int j) const {
  const Nets& nets = nets_[static_cast<std::size_t>(j)];
  return net == Net::excitation ? nets.gate.acted() : net == Net::covariance ? nets.bound.acted() : nets.huber.acted();
}

void EstimatorBank::watch(std::size_t j, double least) {
  const auto tell = [&](NetState& state, bool acts, Net net, double value, double limit) {
    const NetState::Change change = state.step(acts);
    if (change == NetState::Change::none) return;
    log_.add({net, change == NetState::Change::begins, static_cast<int>(j), sample_, value, limit, Refusal::none});
  };
  const FrequencyPoint::Acting& acting = points_[j].acting();
  tell(nets_[j].gate, acting.gate, Net::excitation, points_[j].excitation(), least);
  tell(nets_[j].bound, acting.bound, Net::covariance, 0.0, 0.0);
  tell(nets_[j].huber, acting.huber, Net::huber, acting.residual, acting.residual_limit);
}

}  // namespace bodeflow::adaptive_control
