#include "catch.hpp"
#include "loop.hpp"

using namespace bodeflow::test;

namespace {

/// Example 4.4: proportional feedback, command of 30 samples a bit.
struct Estimation {
  std::vector<std::complex<double>> truth;
  std::vector<std::vector<std::complex<double>>> estimates;
  std::vector<double> variance;  ///< after the last sample

  double error(std::size_t k, std::size_t j) const { return std::abs(estimates[k][j] / truth[j] - 1.0); }
};

Estimation estimate(const ac::FrequencyPointSettings& point, int d, int samples, double noise = 0.0, std::uint64_t seed = 1,
                    int clock = 30, double pole = 0.0) {
  ac::BankSettings s;
  s.omega = {0.1, 0.5, 0.7};
  s.delays = {d};
  s.point = point;
  auto bank = ac::EstimatorBank::make(s);
  REQUIRE(bank);
  SimulatedPlant plant(fifth_order(), 0.0);
  Command command(clock);
  bodeflow::numerics::Random random(seed);
  Estimation e;
  e.truth = *ac::sampled_response(fifth_order(), 0.0, 1.0, s.omega);
  double u = 0.0, coloured = 0.0;
  for (int k = 0; k < samples; ++k) {
    coloured = pole * coloured + noise * random.normal();
    const double y = plant.output() + coloured, u_c = command.next();
    bank->step(y, u, u_c);
    e.estimates.emplace_back(bank->response(), bank->response() + 3);
    u = u_c - y;
    plant.input(u);
  }
  e.variance = {bank->variance(0), bank->variance(1), bank->variance(2)};
  return e;
}

ac::FrequencyPointSettings plain(int denominator, int numerator) {
  ac::FrequencyPointSettings s;
  s.denominator = denominator;
  s.numerator = numerator;
  s.gate = s.bound = s.huber = false;
  return s;
}

}  // namespace

TEST_CASE("example 4.4: three parameters are within 1.5 % after 30 samples, two parameters are not within 3 %") {
  const Estimation three = estimate(plain(2, 1), 2, 500), two = estimate(plain(1, 1), 2, 500);
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK(three.error(30, j) < 0.015);
    CHECK(two.error(30, j) > 0.03);
    for (std::size_t k = 30; k < 500; ++k) REQUIRE(three.error(k, j) < 0.015);
  }
}

TEST_CASE("a plant that is one of the models is estimated exactly, with each structure of section 4.2") {
  struct Case {
    int n_a, n_b, d;
    bodeflow::numerics::TransferFunction plant;
    double delay;
  };
  for (const Case& c :
       {Case{2, 1, 3, {poly({1}), poly({1, 0.5}), 0.0}, 3.0}, Case{1, 1, 3, {poly({1}), poly({1, 0.5}), 0.0}, 3.0},
        Case{1, 2, 3, {poly({1}), poly({1, 0.5}), 0.0}, 3.4}, Case{2, 2, 0, {poly({1}), poly({1, 1, 1}), 0.0}, 0.0},
        Case{0, 2, 4, {poly({2}), poly({1, 40}), 0.0}, 4.3}}) {
    ac::BankSettings s;
    s.omega = {0.2, 0.6};
    s.delays = {c.d};
    s.point = plain(c.n_a, c.n_b);
    auto bank = ac::EstimatorBank::make(s);
    REQUIRE(bank);
    SimulatedPlant plant(c.plant, c.delay);
    bodeflow::numerics::Random random(5);
    double u = 0.0;
    for (int k = 0; k < 600; ++k) {
      bank->step(plant.output(), u);
      u = random.normal();
      plant.input(u);
    }
    const auto truth = ac::sampled_response(c.plant, c.delay, 1.0, s.omega);
    INFO(c.n_a << " " << c.n_b << " " << c.d);
    for (std::size_t j = 0; j < 2; ++j) CHECK(std::abs(bank->response()[j] / (*truth)[j] - 1.0) < 1e-4);
  }
}

TEST_CASE("each frequency has its own delay, and scales change nothing but the units") {
  ac::BankSettings s;
  s.omega = {0.2, 0.6};
  s.delays = {3, 2};
  s.point = plain(2, 1);
  auto bank = ac::EstimatorBank::make(s);
  s.input_scale = 50.0;
  s.output_scale = 0.02;
  auto scaled = ac::EstimatorBank::make(s);
  SimulatedPlant plant({poly({1}), poly({1, 0.5}), 0.0}, 3.0);
  bodeflow::numerics::Random random(5);
  double u = 0.0;
  for (int k = 0; k < 400; ++k) {
    bank->step(plant.output(), u);
    scaled->step(0.02 * plant.output(), 50.0 * u);
    u = random.normal();
    plant.input(u);
  }
  for (int j = 0; j < 2; ++j) {
    CHECK(std::abs(scaled->response()[j] * 2500.0 / bank->response()[j] - 1.0) < 1e-12);
    CHECK(scaled->variance(j) * 2500.0 * 2500.0 == Approx(bank->variance(j)).epsilon(1e-9));
  }
}

TEST_CASE("the predicted variance is that of 60 runs within a factor of 2.5") {
  for (const ac::Method method : {ac::Method::least_squares, ac::Method::instrumental}) {
    ac::FrequencyPointSettings s = plain(2, 1);
    s.p0 = 1e4;
    s.method = method;
    std::vector<Estimation> runs;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) runs.push_back(estimate(s, 2, 1500, 0.05, seed, 5));
    for (std::size_t j = 0; j < 3; ++j) {
      double squares = 0.0, predicted = 0.0;
      std::complex<double> mean = 0.0;
      for (const Estimation& e : runs) {
        mean += e.estimates.back()[j] / 60.0;
        predicted += e.variance[j] / 60.0;
      }
      for (const Estimation& e : runs) squares += std::norm(e.estimates.back()[j] - mean) / 59.0;
      INFO("point " << j << ": " << squares << " and " << predicted);
      CHECK(predicted / squares > 0.4);
      CHECK(predicted / squares < 2.5);
    }
  }
}

TEST_CASE("instrumental variables have half the bias that strong noise gives least squares, or less") {
  const auto worst_bias = [](ac::Method method) {
    ac::FrequencyPointSettings s = plain(2, 1);
    s.p0 = 1e4;
    s.method = method;
    std::vector<std::complex<double>> mean(3), truth;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Estimation e = estimate(s, 2, 3000, 0.15, seed, 5);
      truth = e.truth;
      for (std::size_t j = 0; j < 3; ++j) mean[j] += e.estimates.back()[j] / 20.0;
    }
    double worst = 0.0;
    for (std::size_t j = 0; j < 3; ++j) worst = std::max(worst, std::abs(mean[j] / truth[j] - 1.0));
    return worst;
  };
  const double least_squares = worst_bias(ac::Method::least_squares), instrumental = worst_bias(ac::Method::instrumental);
  INFO(least_squares << " and " << instrumental);
  CHECK(instrumental < 0.5 * least_squares);
}

TEST_CASE("extended least squares take away the bias of noise that is a moving average") {
  const auto bias = [](ac::Method method) {
    ac::FrequencyPointSettings s = plain(1, 1);
    s.filter_radius = 0.05;  // next to no filter
    s.filter_sections = 1;
    s.omega = 0.6;
    s.method = method;
    s.noise_terms = 3;
    auto point = ac::FrequencyPoint::make(s);
    bodeflow::numerics::Random random(11);
    double y = 0.0, u = 0.0, before = 0.0;
    for (int k = 0; k < 20000; ++k) {  // y(k) = 0.8 y(k-1) + 0.2 u(k-1) + e(k) + 0.9 e(k-1)
      const double e = 0.1 * random.normal();
      y = 0.8 * y + 0.2 * u + e + 0.9 * before;
      before = e;
      point->step({y, u, 0.0, 0.0});
      u = random.normal();
    }
    const std::complex<double> z = std::polar(1.0, 0.6), truth = 0.2 / (z - 0.8);
    return std::abs(point->response() / truth - 1.0);
  };
  const double least_squares = bias(ac::Method::least_squares), extended = bias(ac::Method::extended);
  INFO(least_squares << " and " << extended);
  CHECK(extended < 0.3 * least_squares);
}

TEST_CASE("directional forgetting keeps its covariance without excitation, exponential forgetting does not") {
  const auto grown = [](bool directional) {
    ac::UdLeastSquares ud(2, 1.0);
    ac::FullLeastSquares full(2, 1.0);
    for (int k = 0; k < 400; ++k) {
      const ac::Regressor phi{1.0, 0.0};  // nothing along the second parameter
      if (directional) {
        full.measure_directional(phi, 0.95);
      } else {
        ud.measure(phi, 0.95);
      }
    }
    return directional ? full.covariance(1, 1) : ud.covariance(1, 1);
  };
  CHECK(grown(true) == 1.0);
  CHECK(grown(false) > 1e8);
}

TEST_CASE("estimators refuse structures and frequencies out of range by name") {
  const auto refusal = [](double omega, int n_a, int n_b, int d, double forgetting) {
    ac::FrequencyPointSettings s = plain(n_a, n_b);
    s.omega = omega;
    s.delay = d;
    s.forgetting = forgetting;
    const auto made = ac::FrequencyPoint::make(s);
    return made ? std::string() : made.error().text;
  };
  CHECK(refusal(0.5, 2, 1, 2, 1.0).empty());
  CHECK(refusal(0.01, 2, 1, 2, 1.0).find("frequency 0.01 rad/s: the centre w h = 0.01 rad is too near zero") == 0);
  CHECK(refusal(3.2, 2, 1, 2, 1.0).find("frequency 3.2 rad/s: the centre w h = 3.2 rad is too near the Nyquist frequency") == 0);
  CHECK(refusal(0.5, 0, 1, 2, 1.0) ==
        "a model with 0 denominator and 1 numerator parameters; allowed: 0 to 2 and 1 to 3, at least 2 together");
  CHECK(refusal(0.5, 2, 1, 65, 1.0) == "delay 65 samples; allowed: 0 to 64");
  CHECK(refusal(0.5, 2, 1, 2, 1.1) == "forgetting 1.1; allowed: above 0, up to 1");
}
