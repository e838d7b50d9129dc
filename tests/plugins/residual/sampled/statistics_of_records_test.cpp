#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "plugins/residual/sampled/records.hpp"
#include "sampled/block_statistics.hpp"
#include "sampled/correlation_tests.hpp"
#include "sampled/noise_model.hpp"
#include "sampled/record_spectra.hpp"
#include "sampled/record_spectrum.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::testing;

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Eigen::VectorXd white(std::uint64_t seed, Eigen::Index samples) { return coloured_noise(seed, samples, 0.0); }

/// How many of `draws` probabilities are below 5 %.
template <class Draw>
int below_five_percent(int draws, Draw draw) {
  int count = 0;
  for (int i = 0; i < draws; ++i) count += draw(static_cast<std::uint64_t>(i)) < 0.05 ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("record filter: derivatives of a line with a slow sine are right, noise beyond the corner is gone") {
  const double t = 1e-3;
  const Eigen::Index n = 4000;
  Eigen::VectorXd x(n), first(n), second(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double time = t * static_cast<double>(i), w = kTwoPi * 2.0;
    x[i] = 0.3 + 0.5 * time + 0.01 * std::sin(w * time) + 1e-3 * std::sin(kTwoPi * 200.0 * time);
    first[i] = 0.5 + 0.01 * w * std::cos(w * time);
    second[i] = -0.01 * w * w * std::sin(w * time);
  }
  const Eigen::Index edge = 200;
  const auto inner = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - b).segment(edge, n - 2 * edge).cwiseAbs().maxCoeff();
  };
  CHECK(inner(smooth_derivative(x, t, 20.0, 1), first) < 1e-5);
  CHECK(inner(smooth_derivative(x, t, 20.0, 2), second) < 1e-3);
  // At the corner 1/sqrt(2) of the amplitude is left.
  for (Eigen::Index i = 0; i < n; ++i) x[i] = std::sin(kTwoPi * 20.0 * t * static_cast<double>(i));
  CHECK(rms(smooth_derivative(x, t, 20.0, 0).segment(edge, n - 2 * edge)) == Approx(0.5).epsilon(0.01));
}

TEST_CASE("record filter: between its samples a band-limited record is where it was") {
  const Eigen::Index n = 1000;
  const auto signal = [](double time) { return std::sin(1.9 * time + 0.3) + 0.4 * std::cos(0.7 * time) + 2.0 + 0.001 * time; };
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = signal(static_cast<double>(i));
  const Eigen::VectorXd fine = interpolated(x, 4);
  REQUIRE(fine.size() == 4 * n);
  double worst = 0.0;
  for (Eigen::Index i = 4 * 60; i < 4 * (n - 60); ++i)
    worst = std::max(worst, std::abs(fine[i] - signal(0.25 * static_cast<double>(i))));
  CHECK(worst < 0.01);
  CHECK(std::abs(fine[400] - x[100]) < 1e-9);
}

TEST_CASE("noise model: finds an autoregression over several stretches, and what it leaves is white") {
  const Eigen::Index n = 6000;
  const Eigen::VectorXd w = white(1, n);
  Eigen::VectorXd e = Eigen::VectorXd::Zero(n);
  const Stretches stretches = {{0, 2000}, {2000, 1500}, {3500, 2500}};
  for (const Stretch& s : stretches)
    for (Eigen::Index i = s.first + 2; i < s.first + s.count; ++i) e[i] = 1.6 * e[i - 1] - 0.8 * e[i - 2] + w[i];
  CHECK(noise_order(e, stretches, 10) >= 2);
  const NoiseModel noise = fit_noise(e, stretches, 2);
  CHECK(noise.coefficients[0] == Approx(-1.6).margin(0.03));
  CHECK(noise.coefficients[1] == Approx(0.8).margin(0.03));
  CHECK(noise.variance == Approx(1.0).epsilon(0.05));
  const Eigen::VectorXd left = innovations(noise, e, stretches);
  CHECK(left.size() == n - 6);
  CHECK(rms(left) == Approx(1.0).epsilon(0.03));
}

TEST_CASE("likelihood gain: chance gains as chi-squared says, whatever the colour of the noise") {
  // A needless parameter: what it takes out of coloured noise is minus the least-squares projection onto a random course.
  const Eigen::Index n = 1000;
  const Stretches all = {{0, n}};
  int above = 0;
  const int draws = 300;
  for (int i = 0; i < draws; ++i) {
    const auto seed = static_cast<std::uint64_t>(2 * i);
    const Eigen::VectorXd e = coloured_noise(seed + 1000, n, 0.95), x = coloured_noise(seed + 1001, n, 0.5);
    const Eigen::VectorXd after = e - x * (x.dot(e) / x.squaredNorm());
    above += likelihood_gain(e, after, all) > numerics::chi_squared_limit(0.05, 1.0) ? 1 : 0;
  }
  // 15 expected at most: least squares does not seek the gain itself, so chance gains less.
  CHECK(above <= 24);
  // Half of the noise gone is told at its worth.
  const Eigen::VectorXd e = coloured_noise(7, n, 0.95);
  CHECK(likelihood_gain(e, Eigen::VectorXd(0.5 * e), all) == Approx(static_cast<double>(n) * std::log(4.0)));
  CHECK(likelihood_gain(e, e, all) == 0.0);
}

TEST_CASE("block deviates: normal where two residuals are equally good, great where one is better") {
  const Eigen::Index n = 4000;
  double sum = 0.0, squares = 0.0;
  const int draws = 200;
  for (int i = 0; i < draws; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const Eigen::VectorXd e = coloured_noise(3 * seed, n, 0.8);
    const Eigen::VectorXd a = e + 0.3 * coloured_noise(3 * seed + 1, n, 0.8), b = e + 0.3 * coloured_noise(3 * seed + 2, n, 0.8);
    const double z = block_deviates(a, b);
    sum += z;
    squares += z * z;
  }
  CHECK(std::abs(sum / draws) < 4.0 / std::sqrt(draws));
  CHECK(std::sqrt(squares / draws) == Approx(1.0).margin(0.2));
  const Eigen::VectorXd e = coloured_noise(9, n, 0.8);
  CHECK(block_deviates(e, 0.9 * e) > 4.0);
}

TEST_CASE("correlations: probabilities hold for a coloured residual and a coloured input") {
  const Eigen::Index n = 1500;
  const Stretches stretches = {{0, 700}, {700, 800}};
  const int draws = 200;
  std::vector<Correlations> all;
  for (int i = 0; i < draws; ++i) {
    const auto seed = static_cast<std::uint64_t>(2 * i + 5000);
    all.push_back(correlate(coloured_noise(seed, n, 0.9), coloured_noise(seed + 1, n, 0.7), Eigen::MatrixXd(n, 0), stretches));
  }
  const auto count = [&](double Correlation::*p, Correlation Correlations::*c) {
    return below_five_percent(draws, [&](std::uint64_t i) { return all[i].*c.*p; });
  };
  // 10 expected; the binomial deviation is 3.
  CHECK(count(&Correlation::p, &Correlations::input) <= 20);
  CHECK(count(&Correlation::p, &Correlations::input) >= 2);
  CHECK(count(&Correlation::p, &Correlations::input_square) <= 22);
  CHECK(count(&Correlation::p, &Correlations::future) <= 20);
  CHECK(all[0].whiteness_p < 1e-10);
  CHECK(all[0].colour == Approx(1.0 / std::sqrt(1.0 - 0.81)).epsilon(0.2));
  int white_ones = below_five_percent(draws, [&](std::uint64_t i) {
    return correlate(white(i, n), white(i + 900, n), Eigen::MatrixXd(n, 0), stretches).whiteness_p;
  });
  CHECK(white_ones <= 20);
}

TEST_CASE("correlations: tell missing dynamics with its lag, an even nonlinearity, feedback, and what the fit takes out") {
  const Eigen::Index n = 3000;
  const Stretches one = {{0, n}};
  const Eigen::VectorXd u = coloured_noise(1, n, 0.5), e = coloured_noise(2, n, 0.9);
  const auto shifted = [&](Eigen::Index lag) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    if (lag >= 0)
      x.tail(n - lag) = u.head(n - lag);
    else
      x.head(n + lag) = u.tail(n + lag);
    return x;
  };
  const Eigen::MatrixXd none(n, 0);
  const Correlations missing = correlate(e + 0.3 * shifted(4), u, none, one);
  CHECK(missing.input.p < 1e-6);
  CHECK(missing.input.lag == 4);
  CHECK(missing.input.largest > 0.1);
  // The direction is one of the fit's: nothing is missing.
  CHECK(correlate(e + 0.3 * shifted(4), u, Eigen::MatrixXd(shifted(4)), one).input.p > 1e-3);
  CHECK(correlate(e.cwiseProduct((1.0 + u.array().square()).matrix()), u, none, one).input_square.p < 1e-6);
  const Correlations loop = correlate(e + 0.5 * shifted(-3), u, none, one);
  CHECK(loop.future.p < 1e-6);
  CHECK(loop.future.lag == -3);
  CHECK(correlate(e, u, none, one).future.p > 1e-3);
}

TEST_CASE("record spectra: the response of a filter, a tone between the noise, a step of level and one of size") {
  const Eigen::Index n = 20000;
  const Eigen::VectorXd u = white(11, n);
  Eigen::VectorXd y(n);
  double state = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    y[i] = state;
    state = 0.5 * state + u[i];
  }
  const MeasuredResponse r = averaged_response(u, y + 0.1 * white(12, n), 1e-3);
  REQUIRE(r.frequency_hz.size() > 100);
  double deviates = 0.0;
  for (std::size_t i = 0; i < r.frequency_hz.size(); ++i) {
    const std::complex<double> z = std::polar(1.0, kTwoPi * r.frequency_hz[i] * 1e-3);
    deviates += std::norm((r.response[i] - 1.0 / (z - 0.5)) * r.weight[i]);
  }
  CHECK(deviates / static_cast<double>(r.frequency_hz.size()) == Approx(1.0).margin(0.7));

  Eigen::VectorXd tone = white(13, n);
  for (Eigen::Index i = 0; i < n; ++i) tone[i] += 0.2 * std::sin(kTwoPi * 50.03 * 1e-3 * static_cast<double>(i));
  const std::vector<double> peaks = peak_frequencies(tone, 1e-3, 3);
  REQUIRE(peaks.size() == 1);
  CHECK(peaks[0] == Approx(50.03).margin(0.01));
  CHECK(peak_frequencies(white(14, n), 1e-3, 3).empty());

  Eigen::VectorXd stepped = white(15, n);
  stepped.tail(n - 7000).array() += 1.0;
  CHECK(std::abs(change_points(stepped, 4).at(0) - 7000) < 20);
  Eigen::VectorXd louder = white(16, n);
  louder.tail(n - 12000) *= 2.0;
  CHECK(std::abs(change_points(louder, 4).at(0) - 12000) < 50);
}

TEST_CASE("drift: the slope of a residual over its record, with its deviation") {
  const Eigen::Index n = 5000;
  const Drift none = drift_of(coloured_noise(3, n, 0.5));
  CHECK(std::abs(none.rise) < 4.0 * none.std);
  const Drift some = drift_of(coloured_noise(3, n, 0.5) + Eigen::VectorXd::LinSpaced(n, 0.0, 1.0));
  CHECK(some.rise == Approx(1.0).margin(4.0 * some.std));
  CHECK(some.std < 0.15);
}
