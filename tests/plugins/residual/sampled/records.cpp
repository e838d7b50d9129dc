#include "plugins/residual/sampled/records.hpp"

#include <cmath>

namespace bodeflow::residual::testing {

records::Recording recording(const Eigen::VectorXd& input, const Eigen::VectorXd& output, double rate_hz,
                             const std::string& input_unit, const std::string& output_unit) {
  records::Recording r;
  r.sample_rate_hz = rate_hz;
  r.input_signals = {{"u"}, {input_unit}};
  r.output_signals = {{"y"}, {output_unit}};
  r.input = input;
  r.output = output;
  return r;
}

Eigen::VectorXd coloured_noise(std::uint64_t seed, Eigen::Index samples, double a) {
  numerics::Random random(seed);
  Eigen::VectorXd e(samples);
  double last = random.normal();
  for (double& x : e) x = last = a * last + std::sqrt(1.0 - a * a) * random.normal();
  return e;
}

Eigen::MatrixXd integrated(const std::function<Eigen::VectorXd(const Eigen::VectorXd&, double)>& f, Eigen::VectorXd x,
                           const Eigen::VectorXd& input, double sample_time_s, int steps) {
  Eigen::MatrixXd states(input.size(), x.size());
  const double h = sample_time_s / steps;
  for (Eigen::Index n = 0; n < input.size(); ++n) {
    states.row(n) = x.transpose();
    for (int i = 0; i < steps; ++i) {
      const double u = input[n];
      const Eigen::VectorXd a = f(x, u), b = f(x + 0.5 * h * a, u), c = f(x + 0.5 * h * b, u), d = f(x + h * c, u);
      x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
  }
  return states;
}

double rms(const Eigen::VectorXd& x) { return std::sqrt(x.squaredNorm() / static_cast<double>(x.size())); }

}  // namespace bodeflow::residual::testing
