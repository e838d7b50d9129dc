#include "spectrum/local_polynomial.hpp"

#include <bodeflow/numerics/confidence.hpp>
#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/random.hpp>
#include <complex>
#include <functional>

#include "catch.hpp"
#include "reference_signal.hpp"
#include "spectrum/welch.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXcd spectra_of(const MatrixXd& x) {
  MatrixXcd s(x.rows() / 2 + 1, x.cols());
  for (Index c = 0; c < x.cols(); ++c) s.col(c) = numerics::half_dft(x.col(c)) / static_cast<double>(x.rows());
  return s;
}

std::vector<std::int64_t> all_lines(Index samples) {
  std::vector<std::int64_t> lines;
  for (std::int64_t k = 1; k <= (samples - 1) / 2; ++k) lines.push_back(k);
  return lines;
}

LocalPolynomialEstimate estimate_of(const MatrixXd& u, const MatrixXd& y, const LocalPolynomial& settings,
                                    const MatrixXd& r = {}) {
  RecordSpectra s{r.size() == 0 ? MatrixXcd() : spectra_of(r), spectra_of(u), spectra_of(y), u.rows()};
  auto e = local_polynomial(s, all_lines(u.rows()), settings);
  INFO((e ? "" : e.error().text));
  REQUIRE(e);
  return *e;
}

VectorXd white(Index samples, std::uint64_t seed, std::uint64_t stream) {
  numerics::Random random = numerics::Random::stream(seed, stream);
  return VectorXd::NullaryExpr(samples, [&] { return random.normal(); });
}

/// y = B/A u with A = 1 + a1 q^-1 + a2 q^-2, B = b q^-1: a resonance, at rest before the first sample.
struct Resonance {
  double a1, a2, b;
  static Resonance at(double omega, double damping) {
    const double radius = std::exp(-damping * omega), angle = omega * std::sqrt(1.0 - damping * damping);
    const double a1 = -2.0 * radius * std::cos(angle), a2 = radius * radius;
    return {a1, a2, 1.0 + a1 + a2};
  }
  VectorXd answer(const VectorXd& u) const {
    VectorXd y = VectorXd::Zero(u.size());
    for (Index n = 1; n < u.size(); ++n) y[n] = b * u[n - 1] - a1 * y[n - 1] - (n > 1 ? a2 * y[n - 2] : 0.0);
    return y;
  }
  Complex response(double omega) const {
    const Complex q = std::polar(1.0, -omega);
    return b * q / (1.0 + a1 * q + a2 * q * q);
  }
  Complex at_line(std::int64_t k, Index samples) const {
    return response(6.283185307179586 * static_cast<double>(k) / static_cast<double>(samples));
  }
};

/// Greatest and rms error over the lines, relative to the rms of the true response.
double rms_error(const LocalPolynomialEstimate& e, const Resonance& plant, Index samples) {
  double error = 0.0, power = 0.0;
  for (std::size_t k = 0; k < e.lines.size(); ++k) {
    const Complex g = plant.at_line(e.lines[k], samples);
    error += std::norm(e.response(static_cast<Index>(k), 0) - g);
    power += std::norm(g);
  }
  return std::sqrt(error / power);
}

double coverage(const LocalPolynomialEstimate& e, const std::function<Complex(std::int64_t, Index)>& truth) {
  double covered = 0.0;
  for (Index k = 0; k < e.response.rows(); ++k) {
    for (Index c = 0; c < e.response.cols(); ++c) {
      const double radius = numerics::confidence_radius(e.variance(k, c), e.degrees_of_freedom, 0.95);
      covered += std::abs(e.response(k, c) - truth(e.lines[static_cast<std::size_t>(k)], c)) <= radius ? 1.0 : 0.0;
    }
  }
  return covered / static_cast<double>(e.response.size());
}

}  // namespace

TEST_CASE("local polynomial: exact where plant and transient are polynomials, ends of the spectrum too") {
  const Index samples = 100;
  numerics::Random random(1);
  RecordSpectra s{{}, MatrixXcd(51, 2), MatrixXcd(51, 1), samples};
  for (auto& u : s.input.reshaped()) u = {random.normal(), random.normal()};
  const auto g = [](double k, int j) { return Complex(1.0 + j - 0.03 * k, 0.2 * j + 0.01 * k + 1e-4 * k * k); };
  for (Index k = 0; k <= 50; ++k) {
    const auto x = static_cast<double>(k);
    s.output(k, 0) = g(x, 0) * s.input(k, 0) + g(x, 1) * s.input(k, 1) + Complex(5.0 - 0.1 * x, 0.002 * x * x);
  }
  LocalPolynomial settings;
  settings.half_width = usual_half_width(settings, 2);
  CHECK(settings.half_width == 8);
  CHECK(settings.degrees_of_freedom(2) == 8);
  const auto e = local_polynomial(s, all_lines(samples), settings);
  REQUIRE(e);
  REQUIRE(e->lines.size() == 49);
  for (Index row = 0; row < 49; ++row) {
    const auto k = static_cast<double>(row + 1);
    CHECK(std::abs(e->response(row, 0) - g(k, 0)) < 1e-11);
    CHECK(std::abs(e->response(row, 1) - g(k, 1)) < 1e-11);
    CHECK(e->transient_level(row, 0) == Approx(std::abs(Complex(5.0 - 0.1 * k, 0.002 * k * k))));
    CHECK(e->noise_level(row, 0) < 1e-12);
  }
}

TEST_CASE("local polynomial: response, variance, noise and transient agree with NumPy") {
  // numpy 1.24.2: linalg.lstsq over lines k-6 .. k+6 with regressors U r^p and r^p, p = 0, 1, 2; the variance from
  // inv(A^H A)[0, 0] sum |residual|^2 / 7. Columns: line, Re G, Im G, var G, noise level, |T|.
  const double rows[][6] = {
      {1, 0.152071900606032, -0.636821383322388, 0.25926903269689, 0.0104824586804592, 0.0671491187175828},
      {20, -0.140048555117762, -0.503639876242294, 0.01218701400947, 0.00862427691269195, 0.00661165805380003},
      {63, -6.00099185589548, -7.80187849016106, 457.904282500413, 0.00401602627020634, 0.10246226355418},
  };
  const MatrixXd signals = test::reference_signal(128);
  const auto e = estimate_of(signals.col(0), signals.col(1), {});
  REQUIRE(e.lines.size() == 63);
  CHECK(e.degrees_of_freedom == 7.0);
  for (const auto& row : rows) {
    const auto k = static_cast<Index>(row[0]) - 1;
    const double size = std::hypot(row[1], row[2]);
    CHECK(std::abs(e.response(k, 0) - Complex(row[1], row[2])) < 1e-7 * size);
    CHECK(e.variance(k, 0) == Approx(row[3]).epsilon(1e-6));
    CHECK(e.noise_level(k, 0) == Approx(row[4]).epsilon(1e-8));
    CHECK(e.transient_level(k, 0) == Approx(row[5]).epsilon(1e-6));
  }
}

TEST_CASE("local polynomial: without noise the error of interpolation falls with the power R + 1 to R + 2 of the length") {
  const Resonance plant = Resonance::at(0.8, 0.1);
  const auto error = [&](Index order, Index samples) {
    LocalPolynomial settings;
    settings.order = order;
    settings.half_width = 8;
    const VectorXd u = white(samples, 2, 0);
    return rms_error(estimate_of(u, plant.answer(u), settings), plant, samples);
  };
  for (const Index order : {2, 4}) {
    const double coarse = error(order, 2048), fine = error(order, 8192);
    const double power = std::log2(coarse / fine) / 2.0;
    INFO("order " << order << ": " << coarse << ", " << fine << ", power " << power);
    CHECK(power > static_cast<double>(order) + 0.7);
    CHECK(fine < 1e-4);
  }
}

TEST_CASE("local polynomial: 95 % regions cover 94 to 96 % of the truth") {
  const Resonance plant = Resonance::at(0.9, 0.2);
  const Index samples = 1024;
  double covered = 0.0, predicted = 0.0, scatter = 0.0;
  const int runs = 60;
  for (int run = 0; run < runs; ++run) {
    const VectorXd u = white(samples, 3, static_cast<std::uint64_t>(run));
    const VectorXd y = plant.answer(u) + 0.3 * white(samples, 4, static_cast<std::uint64_t>(run));
    const auto e = estimate_of(u, y, {});
    covered += coverage(e, [&](std::int64_t k, Index) { return plant.at_line(k, samples); }) / runs;
    // The ends of the spectrum extrapolate; their few lines would rule the sums.
    for (Index k = 10; k < 500; ++k) {
      predicted += e.variance(k, 0);
      scatter += std::norm(e.response(k, 0) - plant.at_line(k + 1, samples));
    }
    CHECK(e.noise_level.array().square().mean() == Approx(0.09 / samples).epsilon(0.2));
  }
  INFO("coverage " << covered << ", variance ratio " << predicted / scatter);
  CHECK(covered > 0.94);
  CHECK(covered < 0.96);
  CHECK(predicted / scatter == Approx(1.0).epsilon(0.1));
}

TEST_CASE("local polynomial: a lightly damped resonance in noise is measured far better than by Welch") {
  const Resonance plant = Resonance::at(0.5, 0.02);
  const Index samples = 8192;
  double ours = 0.0, theirs = 0.0;
  const int runs = 4;
  for (int run = 0; run < runs; ++run) {
    const VectorXd u = white(samples, 5, static_cast<std::uint64_t>(run));
    MatrixXd signals(samples, 2);
    signals << u, plant.answer(u) + 0.01 * white(samples, 6, static_cast<std::uint64_t>(run));
    ours += std::pow(rms_error(estimate_of(u, signals.col(1), {}), plant, samples), 2) / runs;
    double best = 1e300;
    for (const Index segment : {256, 512, 1024, 2048}) {
      WelchSettings s;
      s.segment = segment;
      s.hop = segment / 2;
      Welch welch(s, 1, 1);
      for (Index n = 0; n + segment <= samples; n += s.hop) welch.add(signals.middleRows(n, segment));
      const auto e = welch.estimate(WelchForm::h1, 1, segment / 2 - 1);
      REQUIRE(e);
      double error = 0.0, power = 0.0;
      for (Index k = 0; k < e->response.rows(); ++k) {
        const Complex g = plant.at_line(k + 1, segment);
        error += std::norm(e->response(k, 0) - g);
        power += std::norm(g);
      }
      best = std::min(best, error / power);
    }
    theirs += best / runs;
  }
  INFO("rms errors: local polynomial " << std::sqrt(ours) << ", best Welch " << std::sqrt(theirs));
  CHECK(std::sqrt(ours) < 0.2 * std::sqrt(theirs));
}

TEST_CASE("local polynomial: a step in the middle of the record gives the response, though the plant does not come to rest") {
  const Resonance plant = Resonance::at(0.3, 0.2);
  const Index samples = 2000;
  VectorXd u = VectorXd::Zero(samples);
  u.tail(samples / 2).setOnes();
  // Before the record begins another step went down, less than a time constant ago.
  VectorXd longer(samples + 110);
  longer << VectorXd::Ones(100), VectorXd::Zero(10), u;
  const VectorXd y = plant.answer(longer).tail(samples);
  LocalPolynomial settings;
  settings.half_width = 8;
  const auto with = estimate_of(u, y, settings);
  settings.transient = false;
  const auto without = estimate_of(u, y, settings);
  double worst = 0.0, worst_without = 0.0;
  for (Index k = 1; k < 180; ++k) {
    const Complex g = plant.at_line(k + 1, samples);
    worst = std::max(worst, std::abs(with.response(k, 0) - g) / std::abs(g));
    worst_without = std::max(worst_without, std::abs(without.response(k, 0) - g) / std::abs(g));
  }
  INFO("worst relative error " << worst << ", without a transient in the fit " << worst_without);
  CHECK(worst < 0.02);
  CHECK(worst_without > 10.0 * worst);
}

TEST_CASE("local polynomial: a chirp over the record gives the response") {
  const Resonance plant = Resonance::at(0.7, 0.1);
  const Index samples = 2000;
  const VectorXd u = VectorXd::NullaryExpr(samples, [](Index n) {
    const double t = static_cast<double>(n);
    return std::sin(0.05 * t + 0.5 * (2.0 / 2000.0) * t * t);  // 0.05 to 2.05 rad a sample
  });
  const VectorXd y = plant.answer(u) + 1e-3 * white(samples, 8, 0);
  const auto e = estimate_of(u, y, {});
  Index covered = 0, lines = 0;
  for (Index k = 60; k < 500; ++k, ++lines) {  // near its ends a chirp looks like a transient
    const Complex g = plant.at_line(k + 1, samples);
    CHECK(std::abs(e.response(k, 0) - g) < 0.05 * std::abs(g) + 0.01);
    covered += std::abs(e.response(k, 0) - g) <= numerics::confidence_radius(e.variance(k, 0), 7.0, 0.95) ? 1 : 0;
  }
  CHECK(static_cast<double>(covered) > 0.9 * static_cast<double>(lines));
}

TEST_CASE("local polynomial: two inputs and two outputs from one record") {
  const Resonance plants[4] = {Resonance::at(0.9, 0.3), Resonance::at(1.2, 0.4), Resonance::at(0.6, 0.5),
                               Resonance::at(2.0, 0.3)};
  const Index samples = 2048;
  double covered = 0.0;
  const int runs = 12;
  for (int run = 0; run < runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    MatrixXd u(samples, 2), y(samples, 2);
    u << white(samples, 20, seed), white(samples, 21, seed);
    u.col(1) = 1e-3 * (u.col(1) + 0.5 * u.col(0));
    for (Index i = 0; i < 2; ++i)
      y.col(i) = plants[2 * i].answer(u.col(0)) + plants[2 * i + 1].answer(u.col(1)) +
                 0.01 * white(samples, 22 + static_cast<std::uint64_t>(i), seed);
    LocalPolynomial settings;
    settings.half_width = usual_half_width(settings, 2);
    covered +=
        coverage(estimate_of(u, y, settings), [&](std::int64_t k, Index c) { return plants[c].at_line(k, samples); }) / runs;
  }
  CHECK(covered > 0.94);
  CHECK(covered < 0.96);
}

TEST_CASE("local polynomial: with a reference the response in a closed loop is right, without it is biased") {
  // u[n] = r[n] - 0.8 y[n], y = G u + v: the direct estimate tends to -1/0.8 where v prevails.
  const Resonance plant = Resonance::at(0.8, 0.4);
  const Index samples = 4096;
  double covered = 0.0, covered_direct = 0.0, ratio = 0.0;
  const int runs = 15;
  for (int run = 0; run < runs; ++run) {
    const VectorXd r = white(samples, 30, static_cast<std::uint64_t>(run)),
                   v = 0.5 * white(samples, 31, static_cast<std::uint64_t>(run));
    VectorXd u(samples), x = VectorXd::Zero(samples), y(samples);
    for (Index n = 0; n < samples; ++n) {
      if (n > 0) x[n] = plant.b * u[n - 1] - plant.a1 * x[n - 1] - (n > 1 ? plant.a2 * x[n - 2] : 0.0);
      y[n] = x[n] + v[n];
      u[n] = r[n] - 0.8 * y[n];
    }
    const auto truth = [&](std::int64_t k, Index) { return plant.at_line(k, samples); };
    const auto closed = estimate_of(u, y, {}, r);
    covered += coverage(closed, truth) / runs;
    covered_direct += coverage(estimate_of(u, y, {}), truth) / runs;
    CHECK(closed.least_input_ratio > 0.0);
    ratio += closed.noise_level.array().square().mean() / (0.25 / samples) / runs;
  }
  INFO("coverage " << covered << ", direct " << covered_direct);
  // To first order in the noise; the reference stands only 8 dB above it at the input.
  CHECK(covered > 0.92);
  CHECK(covered < 0.96);
  CHECK(covered_direct < 0.9);
  CHECK(ratio == Approx(1.0).epsilon(0.1));
}

TEST_CASE("local polynomial: what cannot be estimated is refused, lines without excitation are left out and named") {
  const VectorXd u = white(64, 40, 0);
  RecordSpectra s{{}, spectra_of(u), spectra_of(2.0 * u), 64};
  LocalPolynomial settings;
  const auto refusal = [&](const LocalPolynomial& with) {
    const auto e = local_polynomial(s, all_lines(64), with);
    return e ? std::string("none") : e.error().text;
  };
  CHECK(refusal(settings) == "none");
  settings.half_width = 2;
  CHECK(refusal(settings) == "half_width 2 gives 5 lines for 6 unknowns; needed: at least one line more");
  settings.half_width = 16;
  CHECK(refusal(settings) == "64 samples give 31 lines; a fit takes 33");
  settings.half_width = 6;
  s.input.bottomRows(15).setZero();
  const auto part = local_polynomial(s, all_lines(64), settings);
  REQUIRE(part);
  CHECK(part->lines.back() == 21);
  CHECK(part->silent_lines == std::vector<std::int64_t>{22, 23, 24, 25, 26, 27, 28, 29, 30, 31});
  CHECK(part->response.rows() == 21);
  s.input.setZero();
  CHECK(refusal(settings) == "the input excites none of the lines enough to estimate a response");
  s.output(3, 0) = std::numeric_limits<double>::infinity();
  CHECK(refusal(settings) == "the values are too large to be transformed");
}
