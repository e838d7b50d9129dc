#include "design_advice.hpp"

#include <algorithm>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

#include "largest_bandwidth.hpp"
#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kLeastGainRatio = 0.95, kMostGainRatio = 1.05, kMostSensitivity = 2.5;
constexpr double kRinging = -0.3;  // real part of a controller pole from where the control signal visibly alternates

class Collected {
 public:
  void judge(bool good, const std::string& note, const std::string& warning) {
    good ? advice_.notes.push_back(note) : advice_.warnings.push_back(note + ": " + warning);
  }
  DesignAdvice take() { return std::move(advice_); }

 private:
  DesignAdvice advice_;
};

void structure_advice(Collected& c, const RstStructure& s, int n_t) {
  c.judge(s.n_r >= 2 && s.n_r <= 4, "controller of order " + std::to_string(s.n_r), "2 to 4 is usual");
  c.judge(s.r_p.size() > 1 && std::abs(s.r_p.sum()) < 1e-12, "integral action",
          "without (z - 1) in R constant disturbances leave an error at rest");
  c.judge(s.n_s == s.n_r && n_t == s.n_r, "degrees of S and T are " + std::to_string(s.n_s) + " and " + std::to_string(n_t),
          "below that of R they delay the controller");
}

void frequency_advice(Collected& c, const RstStructure& s, const PlantKnowledge& plant) {
  const auto [least, most] = std::minmax_element(s.omega.begin(), s.omega.end());
  const double ratio = *most / *least;
  c.judge(ratio >= 2.0 && ratio <= 20.0, "frequencies of fitting from " + text_of(*least) + " to " + text_of(*most) + " rad/s",
          "spread them over about a decade");
  if (!plant.omega_180) return;
  c.judge(*most <= 1.3 * *plant.omega_180 && *most >= 0.4 * *plant.omega_180,
          "highest frequency of fitting is " + text_of(*most / *plant.omega_180) + " times omega_-180",
          "about 1 is good; higher ones ask for phase lead that a low order does not have");
}

void demand_advice(Collected& c, const RstStructure& s, const DesiredResponse& desired, const PlantKnowledge& plant) {
  const double bandwidth = bandwidth_of(desired.a_m);
  const auto degree = static_cast<int>(desired.a_m.size()) - 1;
  const double w_h = bandwidth * s.sample_time;
  c.judge(w_h >= 0.2 && w_h <= 0.6, "bandwidth of G_m " + text_of(bandwidth) + " rad/s, omega h = " + text_of(w_h),
          w_h < 0.2 ? "0.2 to 0.6 is usual: sample more slowly" : "0.2 to 0.6 is usual: sample faster");
  if (plant.omega_180) {
    c.judge(bandwidth <= 1.2 * *plant.omega_180, "bandwidth over omega_-180 is " + text_of(bandwidth / *plant.omega_180),
            "not far above 1 where G_m has no delay");
  }
  if (plant.order) {
    c.judge(degree == *plant.order,
            "degree of A_m is " + std::to_string(degree) + ", that of the plant " + std::to_string(*plant.order),
            "the same degree fits best");
  }
  if (plant.delay_s) {
    c.judge(desired.delay_s >= *plant.delay_s * (1.0 - 1e-9),
            "delay of G_m " + text_of(desired.delay_s) + " s, of the plant " + text_of(*plant.delay_s) + " s",
            "no controller takes a true delay away: keep it in G_m");
  }
  if (desired.a_o.size() > 1) {
    const double ratio = time_constant(desired.a_o) / time_constant(desired.a_m);
    c.judge(ratio >= 0.2 && ratio <= 2.5, "time constant of A_o is " + text_of(ratio) + " times that of A_m",
            ratio < 0.2 ? "a fast observer takes bandwidth from the command" : "disturbances are rejected slowly");
  }
  if (plant.anti_alias) {
    c.judge(bandwidth <= 0.1 * *plant.anti_alias, "anti-alias filter of " + text_of(*plant.anti_alias) + " rad/s",
            "less than a decade above the bandwidth: count it as a delay of about " + text_of(1.4 / *plant.anti_alias) +
                " s, in the delay of G_m and in the estimators");
  }
}

}  // namespace

double time_constant(const Eigen::VectorXd& polynomial) {
  const auto poles = numerics::roots(polynomial);
  double sum = 0.0;
  if (poles) {
    for (const std::complex<double>& pole : *poles) sum += 1.0 / std::abs(pole);
  }
  return sum;
}

DesignAdvice advice_before(const RstStructure& structure, const DesiredResponse& desired, const PlantKnowledge& plant) {
  Collected c;
  structure_advice(c, structure, static_cast<int>(desired.a_o.size()) - 1);
  frequency_advice(c, structure, plant);
  demand_advice(c, structure, desired, plant);
  return c.take();
}

DesignAdvice forgetting_advice(double forgetting) {
  Collected c;
  const std::string remembered =
      forgetting < 1.0 ? "about " + text_of(std::round(2.0 / (1.0 - forgetting))) + " samples count, for a plant that changes"
                       : "all samples count alike, for a plant that stays; 0.98 to 0.99 follows one that changes";
  c.judge(forgetting >= 0.98, "forgetting " + text_of(forgetting) + ": " + remembered,
          "below 0.98 the estimates forget faster than the filters respond");
  return c.take();
}

DesignAdvice advice_after(const RstResult& result, const std::optional<LoopQuality>& quality, double sensitivity_at_points) {
  Collected c;
  c.judge(result.gain_ratio >= kLeastGainRatio && result.gain_ratio <= kMostGainRatio,
          "S(1) / T(1) before scaling is " + text_of(result.gain_ratio),
          "off by more than 5 %: the demands are too high for this structure, or the points lie badly");
  if (quality) {
    c.judge(quality->controller_pole > kRinging, "leftmost controller pole at " + text_of(quality->controller_pole),
            "on the negative real axis: the control signal rings, lower the bandwidth or slow the observer");
    c.judge(quality->sensitivity <= kMostSensitivity, "M_s " + text_of(quality->sensitivity),
            "above 2.5: the loop is fragile, lower the bandwidth");
    c.judge(quality->largest_pole < 1.0, "largest closed-loop pole " + text_of(quality->largest_pole), "the loop is unstable");
  } else {
    c.judge(sensitivity_at_points <= kMostSensitivity, "sensitivity at the points " + text_of(sensitivity_at_points),
            "above 2.5: lower the bandwidth");
  }
  return c.take();
}

}  // namespace bodeflow::adaptive_control
