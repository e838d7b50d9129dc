// What is said of models that should not be trusted.

#include "catch.hpp"
#include "maximum_likelihood/model_warnings.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

std::vector<std::string> warnings_of(const Spectra& spectra, const Settings& s, bool variance = true) {
  const auto id = identify(spectra, s);
  REQUIRE(id);
  Measured m;
  m.has_variance = variance;
  m.output_names = {"speed"};
  return model_warnings(*id, m);
}

bool says(const std::vector<std::string>& warnings, const std::string& part) {
  for (const std::string& w : warnings) {
    if (w.find(part) != std::string::npos) return true;
  }
  return false;
}

const Eigen::VectorXd kOmega = log_spaced(1.0, 100.0, 60);

Spectra example(Eigen::Index order, double delay_s = 0.0) {
  numerics::Random random(11);
  return measured(ladder(order, kOmega, 0.0, delay_s), kOmega, {0.005, 0.01, 0.0}, random);
}

}  // namespace

TEST_CASE("maximum likelihood: nothing is warned of where the model is right") {
  for (const Eigen::Index order : {2, 3}) {
    const auto warnings = warnings_of(example(order), settings(Domain::s, order));
    CAPTURE(warnings);
    CHECK(warnings.empty());
  }
}

TEST_CASE("maximum likelihood: an order too low shows in cost, residuals and covariance") {
  const Spectra data = example(3);
  const auto id = identify(data, settings(Domain::s, 2));
  REQUIRE(id);
  CHECK(id->covariance_kind == CovarianceKind::residuals);
  CHECK(*id->test.probability < 1e-10);
  REQUIRE(id->whiteness[0]);
  CHECK(id->whiteness[0]->probability < 1e-6);
  const auto warnings = warnings_of(data, settings(Domain::s, 2));
  CHECK(says(warnings, "times what the noise explains: the data hold what the model does not"));
  CHECK(says(warnings, "the residuals of 'speed' are not independent from line to line"));
}

TEST_CASE("maximum likelihood: a pole and a zero too many are told") {
  const auto warnings = warnings_of(example(2), settings(Domain::s, 3));
  CAPTURE(warnings);
  CHECK(says(warnings, "may cancel, within their uncertainty: lower the order"));
}

TEST_CASE("maximum likelihood: an unstable plant is identified and told") {
  const Rational truth{list({2.0, -30.0}), list({}), 100.0, 0.0, 0.0};
  numerics::Random random(3);
  const Spectra data = measured(truth, kOmega, {0.0, 0.005, 0.0}, random);
  Settings s = settings(Domain::s, 2);
  s.numerator_orders = {0};
  const auto id = identify(data, s);
  REQUIRE(id);
  CHECK(root_error(id->fit.models[0].poles, truth.poles) < 0.05);
  CHECK(says(warnings_of(data, s), "is unstable, by "));
}

TEST_CASE("maximum likelihood: a delay outside its range stays at the end of it and is told") {
  Settings s = settings(Domain::s, 2);
  s.estimate_delay = true;
  s.delay_range_s = std::pair(0.0, 1e-3);
  const auto id = identify(example(2, 3e-3), s);
  REQUIRE(id);
  CHECK(id->fit.models[0].delay_s == 1e-3);
  CHECK(id->fit.parameters() == 4);
  CHECK(says(warnings_of(example(2, 3e-3), s), "the delay is at the end of its range, 0.001 s"));
}

TEST_CASE("maximum likelihood: a response without variance, few periods and a noisy input are told") {
  Settings s = settings(Domain::s, 2);
  s.weighting = Weighting::relative;
  CHECK(says(warnings_of(example(2), s, false), "the response has no variance"));
  Spectra few = example(2);
  few.degrees_of_freedom = 2.0;
  const auto warnings = warnings_of(few, settings(Domain::s, 2));
  CHECK(says(warnings, "the variances have only 2 degrees of freedom (3 periods)"));
  numerics::Random random(5);
  const Spectra noisy = measured(ladder(2, kOmega, 0.0, 0.0), kOmega, {0.4, 0.1, 0.0}, random);
  CHECK(says(warnings_of(noisy, settings(Domain::s, 2)), "the input is less than 10 dB above its noise at "));
}

TEST_CASE("maximum likelihood: variances that are too large are told") {
  Spectra data = example(2);
  data.output_variance *= 4.0;
  data.input_variance *= 4.0;
  CHECK(says(warnings_of(data, settings(Domain::s, 2)), "the variances are too large"));
}

TEST_CASE("maximum likelihood: a numerator that data do not tell from the delay is told by name") {
  const Rational plant{list({Complex(-1.5, 14.0), Complex(-1.5, -14.0)}), list({}), 200.0, 3.7e-3, 0.0};
  numerics::Random random(4);
  const Spectra data = measured(plant, kOmega, {0.0, 0.01, 0.0}, random);
  Settings s = settings(Domain::s, 2);
  s.estimate_delay = true;
  const auto id = identify(data, s);
  REQUIRE(id);
  CHECK(id->fit.structure.numerator_orders == std::vector<Eigen::Index>{0});
  CHECK(id->covariance_root.size() != 0);
  CHECK(warnings_of(data, s).empty());
  s.numerator_orders = {1};
  CHECK(says(warnings_of(data, s), "the data do not tell b1 from the delay: a numerator of order 0 explains them as well"));
  s.numerator_orders = {0};
  CHECK(warnings_of(data, s).empty());
}
