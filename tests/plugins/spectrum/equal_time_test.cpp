#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cstdio>
#include <iostream>
#include <numbers>

#include "catch.hpp"
#include "spectrum/settling.hpp"
#include "spectrum/sine_response.hpp"
#include "three_modes.hpp"

// Stepped sine and multisine at equal time on three lightly damped modes: 60 frequencies of 0.5 to 20 rad/s with a constant
// ratio, peak amplitude 1, white noise of 0.1 % of the rms of |G| in each sample.

using namespace bodeflow;
using bodeflow::test::ThreeModes;
using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

constexpr int kFrequencies = 60;
constexpr std::int64_t kWindow = 64;  // samples of a period of the stepped sine
constexpr double kNoiseShare = 1e-3;

double omega(int k) { return 0.5 * std::pow(40.0, k / (kFrequencies - 1.0)); }

double noise_std() {
  double power = 0.0;
  for (int k = 0; k < kFrequencies; ++k) {
    power += std::norm(ThreeModes(2.0 * pi / omega(k) / kWindow).response(2.0 * pi / kWindow));
  }
  return kNoiseShare * std::sqrt(power / kFrequencies);
}

/// The time of 100 periods at each frequency.
double common_time() {
  double time = 0.0;
  for (int k = 0; k < kFrequencies; ++k) time += 100.0 * 2.0 * pi / omega(k);
  return time;
}

struct Errors {
  double time = 0.0;
  double relative = 0.0;   // ||G - Ghat|| / ||G|| over all frequencies
  double largest = 0.0;    // |G - Ghat| / |G|
  double predicted = 0.0;  // what the variances say of `relative`; 0 where there are none
};

/// Collects estimates and true values.
class Comparison {
 public:
  void add(Complex estimate, Complex truth, double variance = 0.0) {
    error_ += std::norm(estimate - truth);
    power_ += std::norm(truth);
    variance_ += variance;
    largest_ = std::max(largest_, std::abs(estimate - truth) / std::abs(truth));
  }
  Errors errors(double time) const { return {time, std::sqrt(error_ / power_), largest_, std::sqrt(variance_ / power_)}; }

 private:
  double error_ = 0.0, power_ = 0.0, variance_ = 0.0, largest_ = 0.0;
};

/// How a stepped sine is measured.
struct Stepping {
  double time_s = 0.0;  // at each frequency; 0: `periods` periods
  std::int64_t periods = 0;
  double range = 0.0;  // in standard deviations: of a sample, or of a coefficient where `corrected`
  bool corrected = false;
  double sample_rate = 0.0;  // 0: kWindow samples a period
};

/// The stepped sine: each frequency from rest, the coefficients averaged from where they stay within the range.
Errors stepped(const Stepping& how, double sigma) {
  Comparison comparison;
  double time = 0.0;
  for (int k = 0; k < kFrequencies; ++k) {
    const double period_s = 2.0 * pi / omega(k);
    const std::int64_t window = how.sample_rate > 0.0 ? std::llround(how.sample_rate * period_s) : kWindow;
    const double sample_time = how.sample_rate > 0.0 ? 1.0 / how.sample_rate : period_s / static_cast<double>(window);
    const std::int64_t periods =
        how.time_s > 0.0 ? std::llround(how.time_s / (sample_time * static_cast<double>(window))) : how.periods;
    ThreeModes plant(sample_time);
    auto random = numerics::Random::stream(7, static_cast<std::uint64_t>(k));
    const double angle = 2.0 * pi / static_cast<double>(window);
    std::vector<double> y(static_cast<std::size_t>(periods * window));
    for (std::size_t n = 0; n < y.size(); ++n)
      y[n] = plant.step(std::sin(angle * static_cast<double>(n % static_cast<std::size_t>(window)))) + sigma * random.normal();
    time += static_cast<double>(y.size()) * sample_time;
    const auto c = spectrum::sliding_correlation(y, window, 1);
    const double range = how.corrected ? spectrum::settling_threshold(sigma, window, how.range) : how.range * sigma;
    const std::size_t from = spectrum::settled_from(c, range);
    comparison.add({spectrum::mean_from(c.b, from), spectrum::mean_from(c.a, from)}, plant.response(angle));
  }
  return comparison.errors(time);
}

/// A flat multisine of peak 1 on lines of `period` samples, with Schroeder's phases.
std::vector<double> flat_multisine(const std::vector<std::int64_t>& numbers, std::int64_t period) {
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(period);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto rank = static_cast<double>(i);
    spectrum[numbers[i]] = std::polar(1.0, -pi * rank * (rank + 1.0) / static_cast<double>(numbers.size()));
  }
  const Eigen::VectorXd u = numerics::inverse_dft(spectrum).real();
  const double peak = u.cwiseAbs().maxCoeff();
  std::vector<double> samples(u.begin(), u.end());
  for (double& x : samples) x /= peak;
  return samples;
}

/// The multisine: 4 periods in `time_s`, the first one dropped, a response from the others at each line.
Errors multisine(const std::vector<std::int64_t>& numbers, std::int64_t period, double time_s, double sigma) {
  const std::vector<double> u = flat_multisine(numbers, period);
  ThreeModes plant(time_s / 4.0 / static_cast<double>(period));
  auto random = numerics::Random::stream(7, 1000);
  numerics::RealDft dft(period);
  Eigen::VectorXd frame = Eigen::Map<const Eigen::VectorXd>(u.data(), period);
  Eigen::VectorXcd spectrum(dft.lines()), input(dft.lines());
  dft.forward(frame, input);
  const auto count = static_cast<Eigen::Index>(numbers.size());
  Eigen::MatrixXcd outputs(3, count);
  for (int p = 0; p < 4; ++p) {
    for (std::int64_t n = 0; n < period; ++n) frame[n] = plant.step(u[static_cast<std::size_t>(n)]) + sigma * random.normal();
    if (p == 0) continue;
    dft.forward(frame, spectrum);
    for (Eigen::Index i = 0; i < count; ++i) outputs(p - 1, i) = spectrum[numbers[static_cast<std::size_t>(i)]];
  }
  Comparison comparison;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::int64_t k = numbers[static_cast<std::size_t>(i)];
    const auto r = spectrum::sine_response(Eigen::VectorXcd::Constant(3, input[k]), outputs.col(i)).value();
    comparison.add(r.response[0], plant.response(2.0 * pi * static_cast<double>(k) / static_cast<double>(period)), r.variance[0]);
  }
  return comparison.errors(time_s);
}

/// The stepped frequencies on the lines of a period, or `count` lines evenly over their band.
std::vector<std::int64_t> stepped_lines(double period_s) {
  std::vector<std::int64_t> numbers;
  for (int k = 0; k < kFrequencies; ++k) numbers.push_back(std::llround(omega(k) * period_s / (2.0 * pi)));
  return numbers;
}
std::vector<std::int64_t> even_lines(double period_s, int count) {
  std::vector<std::int64_t> numbers;
  const double first = 0.5 * period_s / (2.0 * pi), step = 39.0 * first / (count - 1);
  for (int i = 0; i < count; ++i) numbers.push_back(std::llround(first + step * i));
  return numbers;
}

bool within(double found, double expected) { return found < 1.5 * expected && found > expected / 1.5; }

void print(const char* scheme, const Errors& e) {
  char row[200], predicted[20] = "";
  if (e.predicted > 0.0) std::snprintf(predicted, sizeof predicted, "%.2g ", e.predicted);
  std::snprintf(row, sizeof row, "| %s | %.3g s | %.2g | %.2g | %s|", scheme, e.time, e.relative, e.largest, predicted);
  std::cout << row << "\n";
}

}  // namespace

TEST_CASE(
    "equal time: the printed 6 sigma test stops early: 30 and 100 periods a frequency give the errors of the specification") {
  const double sigma = noise_std();
  const Errors few = stepped({.periods = 30, .range = 6}, sigma), more = stepped({.periods = 100, .range = 6}, sigma);
  CHECK(within(few.relative, 0.103));
  CHECK(within(more.relative, 1.6e-3));
  CHECK(within(few.time, 6.1e3));
  CHECK(within(more.time, 2.02e4));
}

TEST_CASE("equal time: in a quarter of the time the multisine is already far better than the stepped sine") {
  const double sigma = noise_std(), time = common_time() / 4.0;
  const Errors steps = stepped({.time_s = time / kFrequencies, .range = 9.6, .corrected = true}, sigma);
  const Errors sines = multisine(stepped_lines(time / 4.0), 1 << 18, time, sigma);
  CHECK(sines.relative < 0.5 * steps.relative);
  CHECK(sines.predicted == Approx(sines.relative).epsilon(0.3));
}

TEST_CASE("equal time: stepped sine and multisine have the errors of the specification within a factor of 1.5", "[long]") {
  const double sigma = noise_std(), time = common_time(), each = time / kFrequencies;
  const std::int64_t period = 1 << 20;  // 65 samples in a period of 20 rad/s
  const double rate = 4.0 * static_cast<double>(period) / time;
  std::cout << "| scheme | total time | relative error | largest | predicted |\n|---|---|---|---|---|\n";
  const auto expect = [](const char* scheme, const Errors& e, double expected) {
    print(scheme, e);
    INFO(scheme << ": " << e.relative << ", expected " << expected);
    CHECK(within(e.relative, expected));
    return e;
  };
  expect("stepped, 6 sigma, 30 periods", stepped({.periods = 30, .range = 6}, sigma), 0.103);
  expect("stepped, 6 sigma, 100 periods", stepped({.periods = 100, .range = 6}, sigma), 1.6e-3);
  expect("stepped, 6 sigma, 300 periods", stepped({.periods = 300, .range = 6}, sigma), 4.0e-5);
  expect("stepped, equal time, 6 sigma", stepped({.time_s = each, .range = 6}, sigma), 1.3e-4);
  expect("stepped, equal time, 2 sigma", stepped({.time_s = each, .range = 2}, sigma), 4.6e-5);
  expect("stepped, equal time, 24 sigma", stepped({.time_s = each, .range = 24}, sigma), 3.6e-4);
  const Errors steps = expect("stepped, equal time, 9.6 sigma sqrt(2/N)",
                              stepped({.time_s = each, .range = 9.6, .corrected = true}, sigma), 3.8e-5);
  const Errors sines =
      expect("multisine, the same 60 lines, 4 periods", multisine(stepped_lines(time / 4), period, time, sigma), 2.5e-5);
  expect("multisine, 2000 lines, 4 periods", multisine(even_lines(time / 4, 2000), period, time, sigma), 1.0e-4);
  CHECK(sines.relative <= steps.relative);
  CHECK(sines.predicted == Approx(sines.relative).epsilon(0.15));
  print("stepped, equal time, at the multisine's sample rate",
        stepped({.time_s = each, .range = 9.6, .corrected = true, .sample_rate = rate}, sigma));
}
