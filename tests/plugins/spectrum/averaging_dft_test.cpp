#include "spectrum/averaging_dft.hpp"

#include <Eigen/LU>
#include <bodeflow/numerics/discretise.hpp>
#include <cmath>
#include <complex>
#include <random>

#include "acquisition/csv.hpp"
#include "catch.hpp"
#include "data.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;

namespace {

/// G and its variance at line k, written out: the discrete Fourier transform of each period, means, and the errors-in-variables
/// formula. u and y: whole periods of N samples.
std::pair<Complex, double> plain(const double* u, const double* y, int N, int P, int k) {
  std::vector<Complex> U(static_cast<std::size_t>(P)), Y(U);
  for (int n = 0; n < N; ++n) {
    const long double angle = -2.0L * 3.14159265358979323846L * static_cast<long double>(static_cast<long>(k) * n % N) / N;
    const Complex w(static_cast<double>(std::cos(angle)) / N, static_cast<double>(std::sin(angle)) / N);
    for (int p = 0; p < P; ++p)
      U[static_cast<std::size_t>(p)] += u[p * N + n] * w, Y[static_cast<std::size_t>(p)] += y[p * N + n] * w;
  }
  Complex u_mean, y_mean, covariance;
  double var_u = 0.0, var_y = 0.0;
  for (std::size_t p = 0; p < U.size(); ++p) u_mean += U[p] / double(P), y_mean += Y[p] / double(P);
  for (std::size_t p = 0; p < U.size(); ++p) {
    var_u += std::norm(U[p] - u_mean) / (P * (P - 1.0));
    var_y += std::norm(Y[p] - y_mean) / (P * (P - 1.0));
    covariance += (Y[p] - y_mean) * std::conj(U[p] - u_mean) / (P * (P - 1.0));
  }
  const Complex G = y_mean / u_mean;
  return {G, std::norm(G) * (var_y / std::norm(y_mean) + var_u / std::norm(u_mean) -
                             2.0 * std::real(covariance / (y_mean * std::conj(u_mean))))};
}

using test::Table;

Estimate estimate_of(const Table& data, int period, int skip, const LineChoice& choice, Form form = Form::errors_in_variables) {
  const auto outputs = static_cast<Eigen::Index>(data.columns.size()) - 1;
  AveragingDft average(period, outputs);
  for (std::int64_t p = skip; (p + 1) * period <= data.rows(); ++p) {
    Eigen::MatrixXd frame(period, outputs + 1);
    for (Eigen::Index c = 0; c <= outputs; ++c) {
      frame.col(c) = Eigen::Map<const Eigen::VectorXd>(data.columns[static_cast<std::size_t>(c)].data() + p * period, period);
    }
    average.add(frame.col(0), frame.rightCols(outputs));
  }
  auto estimate = average.estimate(choice, form);
  REQUIRE(estimate);
  return *estimate;
}

void compare_with_plain(const Table& data, int period, int skip, const Estimate& e) {
  const int periods = static_cast<int>(data.rows() / period) - skip;
  CHECK(e.periods == periods);
  double worst_response = 0.0, worst_variance = 0.0;
  for (std::size_t row = 0; row < e.lines.size(); ++row) {
    for (std::size_t i = 1; i < data.columns.size(); ++i) {
      const auto offset = static_cast<std::ptrdiff_t>(skip) * period;
      const auto [G, variance] = plain(data.columns[0].data() + offset, data.columns[i].data() + offset, period, periods,
                                       static_cast<int>(e.lines[row]));
      const auto r = static_cast<Eigen::Index>(row), c = static_cast<Eigen::Index>(i) - 1;
      worst_response = std::max(worst_response, std::abs(e.response(r, c) - G) / std::abs(G));
      worst_variance = std::max(worst_variance, std::abs(e.variance(r, c) - variance) / variance);
    }
  }
  INFO("worst relative error of the response " << worst_response << ", of the variance " << worst_variance);
  CHECK(worst_response < 1e-9);
  CHECK(worst_variance < 1e-9);
}

LineChoice band(int first, int last, int step = 1) {
  LineChoice choice;
  for (int k = first; k <= last; k += step) choice.candidates.push_back(k);
  return choice;
}

/// One period of a multisine with these lines, amplitude 1 each.
Eigen::VectorXd multisine(int N, const std::vector<std::int64_t>& lines, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0.0, 6.283185307179586);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(N);
  for (const std::int64_t k : lines) {
    const double p = phase(random);
    for (int n = 0; n < N; ++n) x[n] += std::cos(6.283185307179586 * static_cast<double>(k * n % N) / N + p);
  }
  return x;
}

}  // namespace

TEST_CASE("averaged DFT: bench data A gives the ratio of mean spectra and the errors-in-variables variance to 1e-9") {
  const auto data = test::shared_table("motorbench_two_mass/multisine_A.csv", {"iq_A", "theta_motor_rad", "theta_load_rad"});
  if (!data) return;
  const Estimate e = estimate_of(*data, 2500, 1, band(11, 250));
  CHECK(e.lines.size() == 240);
  CHECK(e.periods == 19);
  compare_with_plain(*data, 2500, 1, e);
}

TEST_CASE("averaged DFT: the project's recording gives the same as ten plain lines to 1e-9, and the plant that made it") {
  const Table data =
      test::table(BODEFLOW_SOURCE_DIR "/graphs/first_steps/recording.csv", {"current", "speed_motor", "speed_load"});
  const Estimate e = estimate_of(data, 400, 2, band(2, 80));
  compare_with_plain(data, 400, 2, e);

  // The drive of make_recording.yaml, at the sample times of a held input.
  Eigen::MatrixXd A(3, 3), B(3, 1), C(2, 3);
  A << -60, 40, -120000, 25, -37.5, 75000, 1, -1, 0;
  B << 200, 0, 0;
  C << 1, 0, 0, 0, 1, 0;
  const auto plant = numerics::zero_order_hold(*numerics::make_state_space(A, B, C, {}), 1e-3)->model;
  double sum = 0.0;
  for (std::size_t row = 0; row < e.lines.size(); ++row) {
    const Complex z = std::polar(1.0, 6.283185307179586 * static_cast<double>(e.lines[row]) / 400.0);
    const Eigen::MatrixXcd resolvent = z * Eigen::MatrixXcd::Identity(3, 3) - plant.A.cast<Complex>();
    const Eigen::VectorXcd truth = plant.C.cast<Complex>() * resolvent.partialPivLu().solve(plant.B.cast<Complex>());
    for (Eigen::Index i = 0; i < 2; ++i) {
      sum += std::norm(e.response(static_cast<Eigen::Index>(row), i) - truth[i]) / e.variance(static_cast<Eigen::Index>(row), i);
    }
  }
  // F(2, 14) has the mean 7/6 and the variance 1.91 (P = 8); 158 of them, four standard deviations of their mean.
  CHECK(sum / 158.0 == Approx(7.0 / 6.0).margin(4.0 * std::sqrt(1.91 / 158.0)));
}

TEST_CASE("averaged DFT: bench data tells its excited lines from what the drive adds between them") {
  const auto a = test::shared_table("motorbench_two_mass/multisine_A.csv", {"iq_A", "theta_motor_rad"});
  const auto b = test::shared_table("motorbench_two_mass/multisine_B.csv", {"iq_A", "theta_motor_rad", "iq_ref_A"});
  if (!a || !b) return;
  LineChoice choice;
  choice.threshold = 0.3;
  const Estimate found = estimate_of(*a, 2500, 1, choice);
  CHECK(found.lines == band(11, 250).candidates);
  // B leaves out some of its odd lines: the reference current, in column 2, tells which.
  const Estimate odd = estimate_of(*b, 2500, 1, choice);
  const Estimate all = estimate_of(*b, 2500, 1, band(1, 1249));
  std::vector<std::int64_t> excited;
  for (std::size_t k = 0; k < all.lines.size(); ++k) {
    if (std::abs(all.output_mean(static_cast<Eigen::Index>(k), 1)) > 0.1) excited.push_back(all.lines[k]);
  }
  CHECK(odd.lines == excited);
  CHECK(odd.lines.size() > 50);
}

TEST_CASE("averaged DFT: exact on noise-free periodic data, whatever the offset") {
  const int N = 200;
  const LineChoice lines = band(1, 99, 7);
  const Eigen::VectorXd u = multisine(N, lines.candidates, 3);
  // y[n] = 0.5 u[n-1] - 2 u[n-3], circular, beside an offset a million times as large.
  Eigen::MatrixXd y(N, 1);
  for (int n = 0; n < N; ++n) y(n, 0) = 1e6 + 0.5 * u[(n + N - 1) % N] - 2.0 * u[(n + N - 3) % N];
  AveragingDft average(N, 1);
  for (int p = 0; p < 3; ++p) average.add(u, y);
  const auto e = average.estimate(lines, Form::errors_in_variables);
  REQUIRE(e);
  for (std::size_t row = 0; row < e->lines.size(); ++row) {
    const double w = 6.283185307179586 * static_cast<double>(e->lines[row]) / N;
    const Complex G = 0.5 * std::polar(1.0, -w) - 2.0 * std::polar(1.0, -3.0 * w);
    const auto r = static_cast<Eigen::Index>(row);
    CHECK(std::abs(e->response(r, 0) - G) < 1e-9);
    CHECK(e->variance(r, 0) < 1e-24);
    CHECK(std::abs(e->input_mean[r]) == Approx(0.5).epsilon(1e-12));
  }
}

TEST_CASE("averaged DFT: means and covariances are those of a two-pass computation for data that drifts") {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 1.0);
  const int N = 60, P = 9;
  Table data;
  data.columns.assign(3, {});
  const LineChoice lines = band(2, 28, 2);
  const Eigen::VectorXd u = multisine(N, lines.candidates, 5);
  for (int n = 0; n < N * P; ++n) {
    const double common = noise(random);
    data.columns[0].push_back(u[n % N] + 0.1 * common);
    data.columns[1].push_back(2.0 * u[(n + 1) % N] + 0.3 * common + 0.05 * noise(random) + 1e-3 * n);
    data.columns[2].push_back(-u[n % N] + noise(random) - 40.0);
  }
  compare_with_plain(data, N, 0, estimate_of(data, N, 0, lines));
}

TEST_CASE("averaged DFT: predicted variance matches Monte Carlo within 10 %, with correlated noise on input and output") {
  const int N = 64, P = 8, runs = 1500;
  const LineChoice lines = band(3, 27, 4);
  const Eigen::VectorXd u = multisine(N, lines.candidates, 1);
  Eigen::VectorXd y(N);
  for (int n = 0; n < N; ++n) y[n] = 1.5 * u[n] - 0.8 * u[(n + N - 2) % N];
  std::mt19937 random(2024);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto count = static_cast<Eigen::Index>(lines.candidates.size());
  for (const Form form : {Form::errors_in_variables, Form::known_input}) {
    const bool noisy_input = form == Form::errors_in_variables;
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(count);
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(count), predicted = squares;
    Eigen::VectorXcd truth(count);
    for (int run = 0; run < runs; ++run) {
      AveragingDft average(N, 1);
      for (int p = 0; p < P; ++p) {
        Eigen::VectorXd up = u, yp = y;
        for (int n = 0; n < N; ++n) {
          const double disturbance = noise(random);  // of both, as in a loop
          if (noisy_input) up[n] += 0.3 * disturbance + 0.1 * noise(random);
          yp[n] += 0.4 * disturbance + 0.2 * noise(random);
        }
        average.add(up, yp);
      }
      const auto e = average.estimate(lines, form);
      REQUIRE(e);
      for (Eigen::Index k = 0; k < count; ++k) {
        const double w = 6.283185307179586 * static_cast<double>(lines.candidates[static_cast<std::size_t>(k)]) / N;
        truth[k] = 1.5 - 0.8 * std::polar(1.0, -2.0 * w);
        sum[k] += e->response(k, 0) - truth[k];
        squares[k] += std::norm(e->response(k, 0) - truth[k]);
        predicted[k] += e->variance(k, 0);
      }
    }
    for (Eigen::Index k = 0; k < count; ++k) {
      const double actual = squares[k] / runs;
      INFO("line " << lines.candidates[static_cast<std::size_t>(k)] << ", known input " << !noisy_input);
      CHECK(predicted[k] / runs == Approx(actual).epsilon(0.1));
      // Bias: within four standard deviations of the mean of the runs.
      CHECK(std::abs(sum[k]) / runs < 4.0 * std::sqrt(actual / runs));
    }
  }
}

TEST_CASE("averaged DFT: 95 % confidence circles hold the truth in 95 % of the runs") {
  // With P periods |dG|^2 / var is F(2, 2P-2) distributed: the radius for 95 % is var x ((0.05)^(-1/(P-1)) - 1) x (P-1).
  const int N = 32, P = 6, runs = 2000;
  const LineChoice lines = band(5, 5);
  const Eigen::VectorXd u = multisine(N, lines.candidates, 9);
  std::mt19937 random(77);
  std::normal_distribution<double> noise(0.0, 0.2);
  const double factor = (std::pow(0.05, -1.0 / (P - 1)) - 1.0) * (P - 1);
  int inside = 0;
  for (int run = 0; run < runs; ++run) {
    AveragingDft average(N, 1);
    for (int p = 0; p < P; ++p) {
      Eigen::VectorXd y = 2.0 * u;
      for (double& x : y) x += noise(random);
      average.add(u, y);
    }
    const auto e = average.estimate(lines, Form::known_input);
    REQUIRE(e);
    inside += std::norm(e->response(0, 0) - 2.0) <= factor * e->variance(0, 0) ? 1 : 0;
  }
  CHECK(inside / double(runs) == Approx(0.95).margin(4.0 * std::sqrt(0.95 * 0.05 / runs)));
}

TEST_CASE("averaged DFT: what cannot be estimated is refused by name") {
  const int N = 20;
  const Eigen::VectorXd u = multisine(N, {3}, 1), silent = Eigen::VectorXd::Constant(N, 5.0);
  AveragingDft average(N, 1);
  CHECK(average.estimate(band(3, 3), Form::known_input).error().text == "the variance needs at least 2 periods; found 0");
  average.add(u, u);
  CHECK(average.estimate(band(3, 3), Form::known_input).error().text == "the variance needs at least 2 periods; found 1");
  average.add(u, u);
  CHECK(average.estimate(band(3, 3), Form::known_input));
  CHECK(average.estimate(band(3, 4), Form::known_input).error().text == "line 4 of the input is not excited");
  AveragingDft still(N, 1);
  for (int p = 0; p < 2; ++p) still.add(silent, u);
  CHECK(still.estimate(band(3, 3), Form::known_input).error().text == "line 3 of the input is not excited");
  LineChoice any;
  any.threshold = 0.3;
  CHECK(still.estimate(any, Form::known_input).error().text ==
        "no line of the input stands out from its noise: is the input excited with this period?");
  AveragingDft huge(N, 1);
  for (int p = 0; p < 2; ++p) huge.add(u, 1e300 * u * (1.0 + p));
  CHECK(huge.estimate(band(3, 3), Form::known_input).error().text == "line 3: the values are too large to be averaged");
}
