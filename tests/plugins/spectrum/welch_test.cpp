#include "spectrum/welch.hpp"

#include <bodeflow/numerics/confidence.hpp>
#include <bodeflow/numerics/random.hpp>
#include <complex>

#include "catch.hpp"
#include "reference_signal.hpp"
#include "spectrum/window.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;
using Eigen::MatrixXd;

namespace {

WelchEstimate estimate_of(const MatrixXd& signals, Eigen::Index inputs, const WelchSettings& settings,
                          WelchForm form = WelchForm::h1) {
  Welch welch(settings, inputs, signals.cols() - inputs);
  for (Eigen::Index n = 0; n + settings.segment <= signals.rows(); n += settings.hop)
    welch.add(signals.middleRows(n, settings.segment));
  auto e = welch.estimate(form, 1, (settings.segment - 1) / 2);
  INFO((e ? "" : e.error().text));
  REQUIRE(e);
  return *e;
}

MatrixXd white(Eigen::Index samples, Eigen::Index channels, numerics::Random& random) {
  MatrixXd x(samples, channels);
  for (double& value : x.reshaped()) value = random.normal();
  return x;
}

WelchSettings settings(Eigen::Index segment, Eigen::Index hop, const char* window) {
  WelchSettings s;
  s.segment = segment;
  s.hop = hop;
  s.window = window;
  return s;
}

/// What many seeds of a static gain of 2 gave.
struct Statistics {
  double covered = 0.0;         ///< share of the 95 % circles that hold the mean response
  double variance_ratio = 0.0;  ///< predicted variance over that of the scatter
  Complex mean;
};

Statistics statistics_of(WelchForm form, double input_noise, double output_noise, const WelchSettings& s, int runs) {
  std::vector<Eigen::VectorXcd> responses;
  std::vector<Eigen::VectorXd> variances;
  double nu = 0.0;
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(7, static_cast<std::uint64_t>(run));
    const MatrixXd x = white(s.segment * 12, 3, random);
    MatrixXd signals(x.rows(), 2);
    signals.col(0) = x.col(0) + input_noise * x.col(1);
    signals.col(1) = 2.0 * x.col(0) + output_noise * x.col(2);
    const WelchEstimate e = estimate_of(signals, 1, s, form);
    responses.push_back(e.response.col(0).segment(2, s.segment / 2 - 6));
    variances.push_back(e.variance.col(0).segment(2, s.segment / 2 - 6));
    nu = e.degrees_of_freedom;
  }
  Statistics result;
  double scatter = 0.0, predicted = 0.0, count = 0.0;
  for (const auto& g : responses) result.mean += g.mean() / static_cast<double>(runs);
  for (std::size_t run = 0; run < responses.size(); ++run) {
    for (Eigen::Index k = 0; k < responses[run].size(); ++k) {
      const double distance = std::norm(responses[run][k] - result.mean);
      scatter += distance;
      predicted += variances[run][k];
      count += 1.0;
      if (std::sqrt(distance) <= numerics::confidence_radius(variances[run][k], nu, 0.95)) result.covered += 1.0;
    }
  }
  result.covered /= count;
  result.variance_ratio = predicted / scatter;
  return result;
}

}  // namespace

TEST_CASE("window: noise bandwidths and overlap figures of the literature") {
  // Harris 1978, table 1 (1.50, 1.36, 1.73, 2.00); flat top 3.77.
  CHECK(noise_bandwidth_lines(window("rectangular", 64)) == Approx(1.0));
  CHECK(noise_bandwidth_lines(window("hann", 64)) == Approx(1.5));
  CHECK(noise_bandwidth_lines(window("hamming", 64)) == Approx(1.3628).epsilon(1e-4));
  CHECK(noise_bandwidth_lines(window("blackman", 64)) == Approx(1.7268).epsilon(1e-4));
  CHECK(noise_bandwidth_lines(window("blackman_harris", 64)) == Approx(2.0044).epsilon(1e-4));
  CHECK(noise_bandwidth_lines(window("flat_top", 64)) == Approx(3.7702).epsilon(1e-4));
  CHECK(window("hann", 8)[0] == 0.0);
  CHECK(window("hann", 8)[4] == 1.0);
  // Half overlapped Hann segments correlate by 1/6 (Harris, table 1: 16.7 %).
  CHECK(effective_averages(window("hann", 4096), 2048, 9) == Approx(9.0 / (1.0 + 2.0 * (8.0 / 9.0) / 36.0)).epsilon(1e-6));
  CHECK(effective_averages(window("rectangular", 64), 64, 20) == 20.0);
  CHECK(effective_averages(window("rectangular", 64), 32, 2) == Approx(2.0 / 1.25));
}

TEST_CASE("welch: densities, coherence and h1 agree with SciPy") {
  // scipy.signal 1.10.1, welch and csd with get_window(w, 64, fftbins=True), fs = 100, nperseg = 64, noverlap = 40, detrend as
  // named; columns: line, P_uu, P_yy, |P_uy|^2 / (P_uu P_yy), Re and Im of P_uy / P_uu.
  struct Row {
    Detrend detrend;
    const char* window;
    Eigen::Index line;
    double uu, yy, coherence, re, im;
  };
  const Row rows[] = {
      {Detrend::mean, "hann", 3, 0.094555026989197863, 0.061729566957824868, 0.99295737197190326, 0.54326904291897149,
       -0.59422537898994465},
      {Detrend::mean, "flat_top", 17, 0.0026676336680382792, 0.00028491598650567121, 0.81343995248860923, -0.14944698739052514,
       -0.25405680618700199},
      {Detrend::linear, "rectangular", 17, 0.0031407540630364141, 0.00045706632909747725, 0.7493442675863492,
       -0.14749778479051598, -0.2954566959239337},
      {Detrend::linear, "hann", 3, 0.093841698170529272, 0.061237486652179651, 0.99295515246031874, 0.54351405097664862,
       -0.59376498523300614},
      {Detrend::none, "flat_top", 3, 0.081904805347676468, 0.055969909998682801, 0.96423063183836877, 0.55151248229861694,
       -0.59560394549586038},
  };
  const MatrixXd signals = test::reference_signal(400);
  for (const Row& row : rows) {
    WelchSettings s = settings(64, 24, row.window);
    s.detrend = row.detrend;
    s.sample_rate_hz = 100.0;
    const WelchEstimate e = estimate_of(signals, 1, s);
    const Eigen::Index k = row.line - 1;
    CHECK(e.averages == 15);
    CHECK(e.input_density(k, 0) == Approx(row.uu).epsilon(1e-10));
    CHECK(e.output_density(k, 0) == Approx(row.yy).epsilon(1e-10));
    CHECK(e.coherence(k, 0) == Approx(row.coherence).epsilon(1e-10));
    CHECK(std::abs(e.response(k, 0) - Complex(row.re, row.im)) < 1e-10);
    // Bendat & Piersol: (1 - gamma^2) / gamma^2 |G|^2 / n, n the degrees of freedom here.
    CHECK(
        e.variance(k, 0) ==
        Approx((1.0 - row.coherence) / row.coherence * std::norm(Complex(row.re, row.im)) / e.degrees_of_freedom).epsilon(1e-8));
  }
}

TEST_CASE("welch: 95 % regions of h1 cover 94 to 96 %, with and without overlap") {
  for (const auto& s : {settings(64, 64, "rectangular"), settings(64, 32, "hann")}) {
    const Statistics found = statistics_of(WelchForm::h1, 0.0, 1.5, s, 400);
    INFO(s.window << ": " << found.covered << ", " << found.variance_ratio);
    CHECK(found.covered > 0.94);
    CHECK(found.covered < 0.96);
    CHECK(found.variance_ratio == Approx(1.0).epsilon(0.06));
    CHECK(std::abs(found.mean - 2.0) < 0.02);
  }
}

TEST_CASE("welch: h1, h2 and hv are right for noise of outputs, of the input, and of both, with their variance") {
  const WelchSettings s = settings(64, 64, "rectangular");
  const Statistics h1_with_noisy_input = statistics_of(WelchForm::h1, 0.5, 0.0, s, 200);
  CHECK(std::abs(h1_with_noisy_input.mean - 2.0 / 1.25) < 0.02);
  const Statistics h2 = statistics_of(WelchForm::h2, 0.5, 0.0, s, 200);
  CHECK(std::abs(h2.mean - 2.0) < 0.03);
  CHECK(h2.variance_ratio == Approx(1.0).epsilon(0.15));
  const Statistics h2_with_noisy_output = statistics_of(WelchForm::h2, 0.0, 1.0, s, 200);
  CHECK(std::abs(h2_with_noisy_output.mean - 2.0 * 1.25) < 0.05);
  const Statistics hv = statistics_of(WelchForm::hv, 0.5, 1.0, s, 200);
  CHECK(std::abs(hv.mean - 2.0) < 0.03);
  CHECK(hv.variance_ratio == Approx(1.0).epsilon(0.15));
  CHECK(hv.covered > 0.93);
}

TEST_CASE("welch: the density of white noise is 2 sigma^2 / rate") {
  numerics::Random random(3);
  WelchSettings s = settings(128, 64, "hann");
  s.sample_rate_hz = 50.0;
  const WelchEstimate e = estimate_of(3.0 * white(128 * 400, 2, random), 1, s);
  CHECK(e.input_density.middleRows(1, 60).mean() == Approx(2.0 * 9.0 / 50.0).epsilon(0.02));
}

TEST_CASE("welch: several inputs are told apart, with the variance of each") {
  const Eigen::Matrix2d gain{{2.0, -1.0}, {0.5, 3.0}};
  const WelchSettings s = settings(32, 32, "rectangular");
  double ratio[4] = {}, covered = 0.0;
  const int runs = 200;
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(11, static_cast<std::uint64_t>(run));
    MatrixXd x = white(32 * 20, 4, random);
    x.col(1) += 0.7 * x.col(0);
    x.col(1) *= 1e-3;  // units of its own
    MatrixXd signals = x;
    signals.rightCols(2) = x.leftCols(2) * gain.transpose() + x.rightCols(2) * Eigen::Vector2d(0.5, 1.0).asDiagonal();
    const WelchEstimate e = estimate_of(signals, 2, s);
    CHECK(e.degrees_of_freedom == 18.0);
    for (Eigen::Index c = 0; c < 4; ++c) {
      const auto error = (e.response.col(c).array() - gain(c / 2, c % 2)).abs().eval();
      ratio[c] += error.square().sum() / e.variance.col(c).sum() / runs;
      for (Eigen::Index k = 0; k < error.size(); ++k)
        covered += error[k] <= numerics::confidence_radius(e.variance(k, c), 18.0, 0.95) ? 1.0 / (4.0 * runs * 15.0) : 0.0;
    }
  }
  for (const double r : ratio) CHECK(r == Approx(1.0).epsilon(0.1));
  CHECK(covered > 0.94);
  CHECK(covered < 0.96);
}

TEST_CASE("welch: what cannot be estimated is refused by name") {
  const WelchSettings s = settings(16, 16, "hann");
  numerics::Random random(5);
  const MatrixXd x = white(16 * 8, 3, random);
  const auto refusal = [&](const MatrixXd& signals, Eigen::Index inputs, WelchForm form, Eigen::Index segments) {
    Welch welch(s, inputs, signals.cols() - inputs);
    for (Eigen::Index m = 0; m < segments; ++m) welch.add(signals.middleRows(16 * m, 16));
    const auto e = welch.estimate(form, 1, 7);
    return e ? std::string("none") : e.error().text;
  };
  CHECK(refusal(x, 1, WelchForm::h1, 8) == "none");
  CHECK(refusal(x, 1, WelchForm::h1, 1) == "1 segment, worth 1 averages; needed: more than 1, one an input");
  MatrixXd silent = x, dependent = x, still = x, huge = x;
  silent.col(0).setConstant(4.0);
  CHECK(refusal(silent, 1, WelchForm::h1, 8) == "line 1 (0.0625 Hz): input 1 is silent there");
  dependent.col(1) = -3.0 * x.col(0);
  CHECK(refusal(dependent, 2, WelchForm::h1, 8) ==
        "line 1 (0.0625 Hz): the inputs depend on each other, so their responses cannot be told apart; drive each with noise of "
        "its own");
  still.col(2).setZero();
  CHECK(refusal(still, 1, WelchForm::h2, 8) == "line 1 (0.0625 Hz): output 2 has nothing in common with the input");
  huge.col(1) *= 1e300;
  CHECK(refusal(huge, 1, WelchForm::h1, 8) == "line 1 (0.0625 Hz): the values are too large to be averaged");
}
