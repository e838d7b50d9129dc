// Diagnosis of a change: windings before and after, in kind as H. Akcay, S. M. Islam, B. Ninness.
#include "validation/change.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "catch.hpp"
#include "windings.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

namespace {

/// A change of one section; the mode at the true poles that moves most.
plants::Ladder deformed(plants::Ladder l, std::size_t section, double factor) {
  l.earth_capacitance_f[section] *= factor;
  l.turn_capacitance_f[section] /= factor;
  return l;
}

ResponseChange change_of(const records::ResponseData& before, const records::ResponseData& after, const Scatter& scatter = {},
                         const ChangeSettings& settings = {}) {
  const auto c = response_change(before, after, scatter, settings);
  INFO((c ? std::string() : c.error().text));
  REQUIRE(c);
  return *c;
}

std::string refusal(const records::ResponseData& before, const records::ResponseData& after, const Scatter& scatter = {}) {
  const auto c = response_change(before, after, scatter, {});
  return c ? "" : c.error().text;
}

int count_of(const EntryChange& e, ModeStatus status) {
  int n = 0;
  for (const ModeChange& m : e.modes) n += m.status == status ? 1 : 0;
  return n;
}

}  // namespace

TEST_CASE("change: two measurements of one winding are unchanged, and the record says what would have been found") {
  const auto l = winding(5, 1);
  const auto f = frequencies(300);
  const auto c = change_of(measured(l, f, 11), measured(l, f, 12));
  CHECK(c.verdict == Verdict::unchanged);
  CHECK(c.conclusion.rfind("unchanged: a change of ", 0) == 0);
  for (const BandChange& b : c.entries[0].spectrum.bands) {
    CHECK(b.detectable < 0.02);
    CHECK(b.probability > c.entries[0].spectrum.level);
  }
  CHECK(count_of(c.entries[0], ModeStatus::moved) == 0);
  CHECK(count_of(c.entries[0], ModeStatus::fresh) == 0);
  CHECK(count_of(c.entries[0], ModeStatus::vanished) == 0);
  CHECK(c.scatter == "unknown");
  CHECK(c.warnings.at(0).rfind("the scatter of repeat tests is unknown", 0) == 0);
}

TEST_CASE("change: a deformed section moves modes by what the true poles say, within the intervals") {
  const auto l = winding(5, 1), d = deformed(l, 2, 1.15);
  const auto f = frequencies(300);
  const auto c = change_of(measured(l, f, 11), measured(d, f, 12));
  CHECK(c.verdict == Verdict::changed);
  const auto poles = [](const plants::Ladder& ladder) {
    std::vector<Mode> modes;
    const Eigen::VectorXcd p = plants::ladder_system(ladder)->A.eigenvalues();
    for (const auto& one : p)
      if (one.imag() > 0.0) modes.push_back({one, Eigen::Matrix2d::Zero()});
    std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) { return a.frequency_hz() < b.frequency_hz(); });
    return modes;
  };
  const auto before = poles(l), after = poles(d);
  REQUIRE(count_of(c.entries[0], ModeStatus::moved) >= 3);
  for (const ModeChange& m : c.entries[0].modes) {
    if (m.status != ModeStatus::moved) continue;
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < before.size(); ++i)
      if (std::abs(before[i].pole - m.before->pole) < std::abs(before[nearest].pole - m.before->pole)) nearest = i;
    const double truth = after[nearest].frequency_hz() / before[nearest].frequency_hz() - 1.0;
    CHECK(std::abs(m.frequency_shift - truth) < 4.0 * m.frequency_shift_deviation);
    CHECK(m.frequency_shift_deviation < 1e-3);
  }
}

TEST_CASE("change: without variance and scatter nothing is decided, with a stated scatter it is") {
  const auto l = winding(3, 2);
  const auto f = frequencies(200);
  auto before = measured(l, f, 1), after = measured(deformed(l, 1, 1.3), f, 2);
  before.variance.resize(0, 0);
  after.variance.resize(0, 0);
  const auto open = change_of(before, after);
  CHECK(open.verdict == Verdict::undecidable);
  CHECK(open.conclusion == "not decidable: neither a variance nor the scatter of repeat tests is known");
  CHECK(std::isnan(open.entries[0].spectrum.bands[0].probability));
  const auto closed = change_of(before, after, Scatter{0.01, 0.0, {}});
  CHECK(closed.verdict == Verdict::changed);
  CHECK(closed.scatter == "stated, 1 % of the response");
  CHECK(closed.warnings.empty());
}

TEST_CASE("change: a scatter of repeat tests hides what the noise alone would show") {
  const auto l = winding(3, 3);
  const auto f = frequencies(200);
  const auto before = measured(l, f, 1);
  auto after = measured(l, f, 2), repeat = measured(l, f, 3);
  after.response *= 1.01;
  repeat.response *= 0.988;
  CHECK(change_of(before, after).verdict == Verdict::changed);
  CHECK(change_of(before, after, Scatter{0.0, 0.0, {repeat}}).verdict != Verdict::changed);
  CHECK(change_of(before, after, Scatter{0.01, 0.0, {}}).verdict == Verdict::unchanged);
}

TEST_CASE("change: where only large changes would be found nothing is called unchanged") {
  const auto l = winding(3, 4);
  const auto f = frequencies(60);
  const auto c = change_of(measured(l, f, 1, 0.8, 0.0), measured(l, f, 2, 0.8, 0.0));
  CHECK(c.verdict == Verdict::undecidable);
  CHECK(c.conclusion.rfind("not decidable in ", 0) == 0);
}

TEST_CASE("change: a mode that goes and one that comes are named") {
  // G = sum of gains w^2 / (s^2 + 2 z w s + w^2): modes at 100, 200 and 400 Hz, then at 100, 280 and 400 Hz.
  const auto f = frequencies(400, 20.0, 1000.0);
  const auto response = [&](double middle, std::uint64_t seed) {
    records::ResponseData r;
    r.input_names = {"u"};
    r.output_names = {"y"};
    r.response_units = {""};
    r.frequency_hz = f;
    r.response.resize(f.size(), 1);
    r.variance = Eigen::MatrixXd::Constant(f.size(), 1, 1e-6);
    numerics::Random random(seed);
    for (Eigen::Index k = 0; k < f.size(); ++k) {
      std::complex<double> g = 0.0;
      for (const double own : {100.0, middle, 400.0})
        g += own * own / std::complex<double>(own * own - f[k] * f[k], 0.04 * own * f[k]);
      const double re = random.normal();
      r.response(k, 0) = g + std::sqrt(0.5e-6) * std::complex<double>(re, random.normal());
    }
    return r;
  };
  const auto c = change_of(response(200.0, 1), response(280.0, 2));
  CHECK(c.verdict == Verdict::changed);
  REQUIRE(c.entries[0].modes.size() == 4);
  CHECK(count_of(c.entries[0], ModeStatus::same) == 2);
  CHECK(c.entries[0].modes[1].status == ModeStatus::vanished);
  CHECK(c.entries[0].modes[1].before->frequency_hz() == Approx(200.0).epsilon(1e-3));
  CHECK(c.entries[0].modes[2].status == ModeStatus::fresh);
  CHECK(c.entries[0].modes[2].after->frequency_hz() == Approx(280.0).epsilon(1e-3));
}

TEST_CASE("change: the probability of an unchanged plant is uniform for few degrees of freedom, too") {
  numerics::Random random(5);
  const auto complex_normal = [&] {
    const double re = random.normal();
    return std::sqrt(0.5) * std::complex<double>(re, random.normal());
  };
  constexpr int kRuns = 400, kLines = 12, kPeriods = 4;
  int below = 0;
  for (int run = 0; run < kRuns; ++run) {
    ChangeLines c;
    c.frequency_hz = frequencies(kLines, 1.0, 10.0);
    c.before = c.after = Eigen::VectorXcd::Zero(kLines);
    c.before_noise = c.after_noise = c.scatter = Eigen::VectorXd::Zero(kLines);
    c.before_degrees = kPeriods - 1;
    for (Eigen::Index k = 0; k < kLines; ++k) {  // all uncertainty before; its variance from the periods
      std::complex<double> x[kPeriods], mean = 0.0;
      for (auto& one : x) mean += (one = complex_normal()) / static_cast<double>(kPeriods);
      double square = 0.0;
      for (const auto& one : x) square += std::norm(one - mean);
      c.before[k] = 1.0 + mean;
      c.after[k] = 1.0;
      c.before_noise[k] = square / (kPeriods - 1.0) / kPeriods;
    }
    const auto s = spectrum_change(c, SpectrumSettings{{0.5, 20.0}, 1, 0.99, 0.1}, 1);
    REQUIRE(s);
    below += change_probability(c, s->significance, 0, kLines) < 0.1 ? 1 : 0;
  }
  CHECK(below > 20);  // 40 +- 6
  CHECK(below < 60);
}

TEST_CASE("change: different frequencies are interpolated and told") {
  auto l = winding(3, 6);
  for (double& r : l.resistance_ohm) r *= 10.0;
  const auto f = frequencies(400);
  const auto c = change_of(measured(l, f, 1), measured(l, Eigen::VectorXd(1.0007 * f), 2), Scatter{2e-3, 0.0, {}});
  CHECK(c.interpolated == 399);
  CHECK(c.left_out == 1);
  CHECK(c.verdict == Verdict::unchanged);
  CHECK(c.warnings.at(0).rfind("the responses stand at different frequencies: the second is interpolated at 399 lines", 0) == 0);
}

TEST_CASE("change: what cannot be compared is refused by name") {
  const auto l = winding(3, 7);
  const auto before = measured(l, frequencies(50), 1);
  auto other = before;
  other.response_units = {"ohm"};
  CHECK(refusal(before, other) == "the response after is in ohm, that before in 1: measure both in the same unit");
  other = before;
  other.output_names = {"a", "b"};
  CHECK(refusal(before, other) == "the response after has 2 outputs and 1 input, that before 1 output and 1 input");
  CHECK(refusal(before, measured(l, frequencies(50, 1e6, 2e6), 2)) == "the responses have 0 lines in common; needed: 8");
  CHECK(refusal(before, before, Scatter{0.0, 0.0, {measured(l, frequencies(49), 3)}}) ==
        "a repeat stands at other frequencies than the response before: measure it at the same lines");
  CHECK(refusal(before, measured(l, frequencies(5), 2)) == "the response after has 5 lines; needed: 8");
}

TEST_CASE("change: factors of equal and of scaled curves") {
  const Eigen::Vector4d x(1.0, 3.0, -2.0, 5.0);
  CHECK(relative_factor(x, x) == 10.0);
  CHECK(relative_factor(x, Eigen::VectorXd(2.0 * x.array() + 7.0)) == 10.0);  // rho knows neither gain nor offset
  // rho by hand: x - mean = (-.75, 1.25, -3.75, 3.25), y - mean = (-2.5, 1.5, -.5, 1.5).
  const Eigen::Vector4d y(0.0, 4.0, 2.0, 4.0);
  const double rho =
      (1.875 + 1.875 + 1.875 + 4.875) / std::sqrt((0.5625 + 1.5625 + 14.0625 + 10.5625) * (6.25 + 2.25 + 0.25 + 2.25));
  CHECK(relative_factor(x, y) == Approx(-std::log10(1.0 - rho)));
  CHECK(correlation_coefficient(x, Eigen::VectorXd(-x)) == Approx(-1.0));
  CHECK(std::isnan(relative_factor(x, Eigen::Vector4d::Ones())));
}

TEST_CASE("change: degrees of deformation by the limits of the standard") {
  const Eigen::VectorXd f = frequencies(600, 1e3, 1e6);
  Eigen::VectorXcd before(f.size());
  for (Eigen::Index k = 0; k < f.size(); ++k) before[k] = 1.0 + 0.5 * std::sin(0.2 * static_cast<double>(k));
  CHECK(standard_factors(f, before, before).deformation == "normal");
  CHECK(standard_factors(f, before, before).bands[0].factor == 10.0);
  Eigen::VectorXcd after = before.reverse();
  CHECK(standard_factors(f, before, after).deformation == "severe");
  CHECK(standard_factors(f.head(100), before.head(100), before.head(100)).deformation.empty());  // 3 kHz: not covered
}
