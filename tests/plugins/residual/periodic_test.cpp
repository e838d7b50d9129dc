#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <map>

#include "catch.hpp"
#include "periodic/periodic_measurement.hpp"
#include "periodic_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::small;
using Complex = std::complex<double>;

namespace {

std::shared_ptr<Mass> mass(Hold hold = Hold::zero_order) {
  auto m = std::make_shared<Mass>();
  m->declared.hold = hold;
  return m;
}

Eigen::VectorXd with(std::vector<double> more) {
  Eigen::VectorXd all(3 + static_cast<Eigen::Index>(more.size()));
  all << mass_values(), Eigen::Map<const Eigen::VectorXd>(more.data(), static_cast<Eigen::Index>(more.size()));
  return all;
}

std::shared_ptr<const Measurement> measured(const records::Recording& r, const BaseModel& base) {
  return periodic_measurement(r, "x", {}, base).value();
}

/// The steady output of the plain mass, and a tenth of a percent of it as noise.
struct Clean {
  std::shared_ptr<Mass> base = mass();
  JointModel model{base, {}};
  Eigen::VectorXd u = multisine(1.0, 1);
  Eigen::VectorXd y = simulate(model, mass_values(), {}, drive(model, mass_values(), u)).value().output;
  double rms = std::sqrt(y.squaredNorm() / kPeriod);

  records::Recording noisy(double part, std::uint64_t seed, double colour = 0.0, Eigen::Index periods = 6) const {
    return recording(u, y, noise((periods + 1) * kPeriod, part * rms, colour, seed), periods);
  }
};

double chi2(const Measurement& m, const JointModel& model, const Eigen::VectorXd& values) {
  return m.residual(model, values).squaredNorm() / static_cast<double>(m.rows());
}

/// The probability of a Kolmogorov-Smirnov distance at least as large, from uniform values (Stephens 1970).
double uniform_p(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double d = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double low = static_cast<double>(i) / n, high = static_cast<double>(i + 1) / n;
    d = std::max({d, values[i] - low, high - values[i]});
  }
  const double x = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * d;
  for (int k = 1; k < 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return std::clamp(sum, 0.0, 1.0);
}

struct Course {
  std::map<std::string, std::vector<double>> p;
  int above_highest = 0, leaks = 0;
};

/// p-values of clean records; fitted: by three steps of Gauss and Newton in the logarithms of the parameters.
Course clean_course(int runs, double colour, bool fitted) {
  const Clean clean;
  Course course;
  for (int n = 0; n < runs; ++n) {
    const auto m = measured(clean.noisy(0.05, 7000 + static_cast<std::uint64_t>(n), colour), *clean.base);
    Eigen::VectorXd at = mass_values(), r = m->residual(clean.model, at);
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(r.size(), 3), covariance = Eigen::MatrixXd::Zero(3, 3);
    for (int round = 0; fitted && round < 3; ++round) {
      for (int i = 0; i < 3; ++i) {
        Eigen::VectorXd moved = at;
        moved[i] *= std::exp(1e-5);
        j.col(i) = (m->residual(clean.model, moved) - r) / 1e-5;
      }
      covariance = (j.transpose() * j).inverse();
      at = at.array() * (-(covariance * (j.transpose() * r))).array().exp();
      r = m->residual(clean.model, at);
    }
    for (const ClassTest& t : m->tests(r, j, covariance, fitted)) course.p[t.name].push_back(t.p);
    const HeldOutError e = m->error(r);
    course.above_highest += e.at_floor() ? 0 : 1;
    course.leaks += e.leak() ? 1 : 0;
  }
  return course;
}

void check_course(int runs) {
  for (const double colour : {0.0, 0.8}) {
    for (const bool fitted : {false, true}) {
      const Course course = clean_course(runs, colour, fitted);
      CHECK(course.p.size() == 7);
      for (const auto& [name, p] : course.p) {
        INFO(name << ", colour " << colour << (fitted ? ", fitted" : ""));
        CHECK(uniform_p(p) > 1e-3);  // one of 28 tests: below 3 % for the family
      }
      CHECK(course.above_highest <= 1 + runs / 150);
      CHECK(course.leaks <= 1);
    }
  }
}

}  // namespace

TEST_CASE("periodic: the right model leaves the noise, in every class, white or coloured, fitted or not") { check_course(60); }

TEST_CASE("periodic: p-values of clean records are uniform over many records", "[long]") { check_course(1000); }

TEST_CASE("periodic: rows are all bins up to 1.25 times the last excited line") {
  const Clean clean;
  const auto m = measured(clean.noisy(0.01, 3), *clean.base);
  CHECK(m->rows() == 2 * (201 * 6) + 1);  // line 201 = 1.25 x 161
  CHECK(m->facts().periods == 6);
  CHECK(m->facts().level == Approx(std::sqrt(clean.u.squaredNorm() / kPeriod)));
  const ResidualPicture picture = m->picture(m->residual(clean.model, mass_values()));
  CHECK(picture.axis == "frequency");
  CHECK(picture.at.size() == 202);
}

TEST_CASE("periodic: the band ends below the Nyquist frequency where the excitation reaches near it") {
  const Clean clean;
  records::Recording r = clean.noisy(0.01, 3);
  r.excited_lines = lines();
  r.excited_lines.push_back(250);
  CHECK(measured(r, *clean.base)->rows() == 2 * (255 * 6) + 1);
}

TEST_CASE("periodic: a wrong parameter shows at the excited lines alone, an offset at zero frequency alone") {
  const Clean clean;
  records::Recording r = clean.noisy(0.02, 4);
  const auto of = [](const Measurement& m, const JointModel& model, const Eigen::VectorXd& v) {
    std::map<std::string, double> p;
    const Eigen::VectorXd left = m.residual(model, v);
    for (const ClassTest& t : m.tests(left, Eigen::MatrixXd(left.size(), 0), Eigen::MatrixXd(0, 0), false)) p[t.name] = t.p;
    return p;
  };
  Eigen::VectorXd wrong = mass_values();
  wrong[1] *= 1.05;
  const auto stiff = of(*measured(r, *clean.base), clean.model, wrong);
  CHECK(stiff.at("excited") < 1e-8);
  for (const char* other : {"odd", "even", "dc", "skirts", "between", "peak"}) CHECK(stiff.at(other) > 1e-3);
  r.output.array() += 0.01 * clean.rms;
  const auto shifted = of(*measured(r, *clean.base), clean.model, mass_values());
  CHECK(shifted.at("dc") < 1e-8);
  for (const char* other : {"excited", "odd", "even", "skirts", "between", "peak"}) CHECK(shifted.at(other) > 1e-3);
}

TEST_CASE("periodic: laws, paths and maps act together as a plant built of them would") {
  // Damping as a law, a lag behind, a second mode beside, an offset in front and a gain behind: all of it in one state space.
  struct Built final : BaseModel {
    Timing declared;
    std::vector<FitParameter> parameters() const override { return {}; }
    Timing timing() const override { return declared; }
    std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {{}}; }
    bool state_space(const double*, const double*, LinearPlant& p) const override {
      const Eigen::VectorXd m = mass_values();
      p.resize(5, 1, 0);
      p.A = {0, 1, 0, 0, 0, -m[2] / m[0], -2 * m[1] / m[0], 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, -900, -9, 0, 50, 0, 50, 0, -50};
      p.B = {0, 1 / m[0], 0, 0.3, 0};
      p.C = {0, 0, 0, 0, 1};
      return true;
    }
  };
  for (const Hold hold : {Hold::zero_order, Hold::band_limited}) {
    auto base = mass(hold);
    auto built = std::make_shared<Built>();
    built->declared.hold = hold;
    auto [bearing, damper] = made(Acts::law, 1, 0);
    damper->law = [](const double* p, const Signals& s, const double*, double*) { return Reaction{p[0] * s.flow, p[0], 0.0}; };
    bearing.what.steps_per_sample = 8;
    auto [lag, lowpass] = made(Acts::series, 1);
    lowpass->passes = [](const double* p, Complex s) { return 1.0 / (1.0 + s * p[0]); };
    auto [mode, beside] = made(Acts::parallel, 1);
    beside->passes = [](const double* p, Complex s) { return p[0] / (s * s + 9.0 * s + 900.0); };
    auto [offset, in_front] = made(Acts::input, 1);
    in_front->maps = [](const double* p, double x, double, double*) { return x + p[0]; };
    auto [gain, behind] = made(Acts::output, 1);
    behind->maps = [](const double* p, double x, double, double*) { return p[0] * x; };
    const JointModel model{base, {bearing, lag, mode, offset, gain}}, whole{built, {}};
    const Eigen::VectorXd u = multisine(1.0, 1), v = with({mass_values()[1], 0.02, 0.3, 0.7, 2.0});
    const records::Recording r = recording(u, Eigen::VectorXd::Zero(kPeriod), noise(7 * kPeriod, 1e-5, 0.0, 2));
    auto [offset_again, again] = made(Acts::input, 0);
    again->maps = [](const double*, double x, double, double*) { return x + 0.7; };
    auto [gain_again, twice] = made(Acts::output, 0);
    twice->maps = [](const double*, double x, double, double*) { return 2.0 * x; };
    const JointModel other{built, {offset_again, gain_again}};
    const Eigen::VectorXd a = measured(r, *base)->residual(model, v),
                          b = measured(r, *built)->residual(other, Eigen::VectorXd(0));
    INFO("hold " << static_cast<int>(hold));
    CHECK((a - b).norm() < 2e-3 * b.norm());
  }
}

TEST_CASE("periodic: an immittance beside a law is found with the flow that both leave") {
  const Clean clean;
  auto [bearing, damper] = made(Acts::law, 1, 0);
  damper->law = [](const double* p, const Signals& s, const double*, double*) {
    return Reaction{p[0] * s.flow * std::abs(s.flow), 2.0 * p[0] * std::abs(s.flow), 0.0};
  };
  auto [again, viscous] = made(Acts::immittance, 1, 0);
  viscous->passes = [](const double* p, Complex) { return Complex(p[0]); };
  const double c = mass_values()[1];
  for (const Hold hold : {Hold::zero_order, Hold::band_limited}) {
    auto base = mass(hold);
    const auto m = measured(clean.noisy(0.01, 5), *base);
    Eigen::VectorXd more = with({300.0});
    more[1] = 2.5 * c;
    const Eigen::VectorXd wanted = m->residual(JointModel{base, {bearing}}, more);
    const Eigen::VectorXd linear = m->residual(JointModel{base, {bearing}}, with({300.0}));
    const Eigen::VectorXd found = m->residual(JointModel{base, {bearing, again}}, with({300.0, 1.5 * c}));
    CHECK((found - wanted).norm() < 0.02 * (linear - wanted).norm());
  }
}

TEST_CASE("periodic: what depends on the time since the record began fills the bins between the lines") {
  const Clean clean;
  auto [bearing, warming] = made(Acts::law, 1, 0);
  bearing.what.nonstationary = true;
  warming->law = [](const double* p, const Signals& s, const double*, double*) {
    const double damping = p[0] * s.time_s;
    return Reaction{damping * s.flow, damping, 0.0};
  };
  const JointModel model{clean.base, {bearing}};
  const double rate = 0.3 * mass_values()[1] / (7.0 * kPeriod / kRate);
  Drive d = drive(model, with({rate}), clean.u);
  d.periods = 7;
  const Eigen::VectorXd y = simulate(model, with({rate}), {}, d).value().output;
  const auto m = measured(recording(clean.u, y, noise(7 * kPeriod, 0.002 * clean.rms, 0.0, 6)), *clean.base);
  CHECK(chi2(*m, model, with({rate})) == Approx(1.0).margin(0.12));
  const Eigen::VectorXd left = m->residual(JointModel{clean.base, {}}, mass_values());
  for (const ClassTest& t : m->tests(left, Eigen::MatrixXd(left.size(), 0), Eigen::MatrixXd(0, 0), false))
    if (t.name == "skirts") CHECK(t.p < 1e-8);
}

TEST_CASE("periodic: a tone between the lines is eliminated with its amplitude and phase, one on a line is left") {
  const Clean clean;
  auto [hum, tone] = made(Acts::tone, 1);
  tone->tones = [](const double* p) { return std::vector<double>{p[0]}; };
  const JointModel model{clean.base, {hum}};
  const double between = 13.37, on_line = 40.0 * kRate / kPeriod;
  for (const double f : {between, on_line}) {
    records::Recording r = clean.noisy(0.02, 8);
    for (Eigen::Index n = 0; n < r.samples(); ++n)
      r.output(n, 0) += 0.02 * clean.rms * std::cos(2.0 * std::numbers::pi * f * static_cast<double>(n) / kRate + 0.4);
    const auto m = measured(r, *clean.base);
    const double before = chi2(*m, clean.model, mass_values()), after = chi2(*m, model, with({f}));
    CHECK(before > 1.2);
    if (f == between) {
      CHECK(after == Approx(1.0).margin(0.12));
      CHECK(m->eliminated(model, with({f})) == 2);
      Situation s;
      m->say(clean.model, mass_values(), Addition::kNoPlace, s);
      REQUIRE_FALSE(s.peaks_hz.empty());
      CHECK(std::abs(s.peaks_hz.front() - between) < 0.2 * kRate / (6 * kPeriod));
    } else {
      CHECK(after == Approx(before).margin(1e-9));
      CHECK(m->eliminated(model, with({f})) == 0);
    }
  }
}

TEST_CASE("periodic: the noise of a measured input counts at the excited lines") {
  const Clean clean;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    records::Recording r = clean.noisy(0.01, 20 + seed);
    r.input.col(0) += noise(r.samples(), 1.0, 0.0, 90 + seed);
    const auto m = measured(r, *clean.base);
    const Eigen::VectorXd left = m->residual(clean.model, mass_values());
    for (const ClassTest& t : m->tests(left, Eigen::MatrixXd(left.size(), 0), Eigen::MatrixXd(0, 0), false))
      if (t.name == "excited") sum += t.multiple / 8.0;
  }
  CHECK(sum == Approx(1.0).margin(0.06));
}

TEST_CASE("periodic: the noise of a measured input counts at the mean, which drives the model too") {
  const Clean clean;
  double sum = 0.0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    records::Recording r = clean.noisy(0.001, 200 + seed);
    r.input.col(0) += noise(r.samples(), 1.0, 0.0, 300 + seed);
    const auto m = measured(r, *clean.base);
    const Eigen::VectorXd left = m->residual(clean.model, mass_values());
    sum += left[0] * left[0] / kRuns;
  }
  CHECK(sum == Approx(1.0).margin(0.6));  // three deviations; without its part it is far above
}

TEST_CASE("periodic: the response is that of the plant behind its hold, with the scatter it states") {
  const Clean clean;
  auto late = mass();
  late->declared.delay_s = 0.003;
  const JointModel model{late, {}};
  const Eigen::VectorXd y = simulate(model, mass_values(), {}, drive(model, mass_values(), clean.u)).value().output;
  const auto m = measured(recording(clean.u, y, noise(7 * kPeriod, 1e-4 * clean.rms, 0.0, 3)), *late);
  const MeasuredResponse g = m->response().front();
  REQUIRE(g.frequency_hz.size() == lines().size());
  for (std::size_t k = 0; k < 40; ++k) {  // below the aliases' reach
    const Complex wanted =
        plant_response(*late, mass_values(), {}, Complex(0.0, 2.0 * std::numbers::pi * g.frequency_hz[k]))(0, 0);
    CHECK(std::abs(g.response[k] - wanted) < 0.05 * std::abs(wanted));
  }
}

TEST_CASE("periodic: two inputs at once drive their two ways") {
  struct Pair final : BaseModel {
    std::vector<FitParameter> parameters() const override { return {real("a", "1", 1.0), real("b", "1", 1.0)}; }
    std::vector<PlantInput> inputs() const override { return {{0, 0}, {1, 0}}; }
    std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {{1.0, 1.0}}; }
    bool state_space(const double* v, const double*, LinearPlant& p) const override {
      p.resize(1, 2, 0);
      p.A = {-20.0};
      p.B = {v[0], v[1]};
      p.C = {1.0};
      return true;
    }
  };
  const Pair base;
  const JointModel model{std::make_shared<Pair>(), {}};
  Eigen::MatrixXd u(kPeriod, 2);
  u << multisine(1.0, 1), multisine(1.0, 2);
  const Eigen::VectorXd v = Eigen::Vector2d(3.0, -2.0);
  Drive d = drive(model, v, refined(u, 8));
  d.hold = Hold::first_order;
  d.values_per_sample = 8;
  const Eigen::VectorXd y = simulate(model, v, {}, d).value().output;
  const auto m = measured(recording(u, y, noise(7 * kPeriod, 0.01 * std::sqrt(y.squaredNorm() / kPeriod), 0.0, 3)), base);
  CHECK(chi2(*m, model, v) == Approx(1.0).margin(0.12));
  CHECK(chi2(*m, model, Eigen::Vector2d(3.0, -1.9)) > 1.5);
}

TEST_CASE("periodic: records that can't be judged are refused with the reason and what would help") {
  const Clean clean;
  const auto refusal = [&](const records::Recording& r) { return periodic_measurement(r, "x", {}, *clean.base).error().text; };
  records::Recording r = clean.noisy(0.01, 1, 0.0, 1);
  CHECK(refusal(r) ==
        "the recording has 1 period after the skipped ones, allowed: 2 or more, so that the noise shows between the lines");
  r = clean.noisy(0.0, 1);
  CHECK(refusal(r) == "output 'position' holds no noise between the lines, so there is nothing to judge a residual by");
  r = clean.noisy(0.01, 1);
  r.input.setZero();
  CHECK(refusal(r) == "the input excites no line");
  r = clean.noisy(0.01, 1);
  r.period = 0;
  CHECK(refusal(r) == "the recording states no period; use the engine for given records");
  r = clean.noisy(0.01, 1);
  r.excited_lines = {3, 256};
  CHECK(refusal(r) == "the last excited line is 256; allowed: below the Nyquist frequency, 255 or less");
  r = clean.noisy(0.01, 1);
  r.output(700, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(r) == "output 'position' is not finite at sample 700");
}
