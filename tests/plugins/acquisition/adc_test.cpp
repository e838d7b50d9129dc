#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <set>

#include "acquisition/adc_block.hpp"
#include "catch.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::BlockDriver;
using test::failure_of;

namespace {

constexpr double kTurn = 2 * M_PI;

StreamFacts stream(double rate, int channels = 1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(rate);
  f.length = 1 << 20;
  f.unit = "V";
  return f;
}

Quantiser quantiser(const ConverterSpec& spec) {
  auto q = Quantiser::make(spec);
  REQUIRE(q);
  return *q;
}

std::vector<double> convert(BlockDriver<Adc>& adc, const std::vector<double>& x, std::int64_t factor, double rate) {
  adc.configure();
  adc.resolve({stream(rate)});
  const std::size_t outputs = x.size() / static_cast<std::size_t>(factor);
  adc.activate(outputs, Rate::from_hz(rate / static_cast<double>(factor)));
  return adc.process({{x}}, outputs)[0][0];
}

/// Power of line `line` over that of all others but zero frequency, in dB.
double signal_to_noise(const std::vector<double>& y, Eigen::Index line) {
  const Eigen::VectorXcd spectrum =
      numerics::half_dft(Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size())));
  double noise = 0.0;
  for (Eigen::Index k = 1; k < spectrum.size(); ++k) noise += k == line ? 0.0 : std::norm(spectrum[k]);
  return 10 * std::log10(std::norm(spectrum[line]) / noise);
}

}  // namespace

TEST_CASE("ADC: levels are mid-tread, from the lower limit to one LSB below the upper one") {
  const auto q = quantiser({-1, 1, 3});
  CHECK(q.step() == 0.25);
  for (const auto& [v, value] :
       {std::pair{0.0, 0.0}, {0.124, 0.0}, {0.126, 0.25}, {-0.124, 0.0}, {-0.126, -0.25}, {0.75, 0.75}, {-1.0, -1.0}}) {
    INFO(v);
    CHECK(q.convert(v).value == value);
    CHECK_FALSE(q.convert(v).clipped);
  }
  CHECK(q.convert(0.874).clipped == false);
  for (const double v : {0.876, 5.0}) CHECK((q.convert(v).clipped && q.convert(v).value == 0.75));
  for (const double v : {-1.126, -5.0}) CHECK((q.convert(v).clipped && q.convert(v).value == -1.0));
  const auto plain = quantiser({-1, 2});
  CHECK(plain.convert(0.3).value == 0.3);
  CHECK((plain.convert(2.5).clipped && plain.convert(2.5).value == 2.0));
}

TEST_CASE("ADC: gain, offset and integral nonlinearity act before rounding") {
  ConverterSpec spec{-1, 1, 8};
  spec.gain_error = 0.5;
  spec.offset_error = 0.125;
  CHECK(quantiser(spec).convert(0.25).value == 0.5);
  ConverterSpec bent{0, 256, 8};
  bent.nonlinearity_lsb = {0, 4, 0};
  const auto q = quantiser(bent);
  CHECK(q.convert(0).value == 0);
  CHECK(q.convert(128).value == 132);
  CHECK(q.convert(64).value == 66);
  CHECK(q.convert(250).value == 250);  // 4 x 6 / 128 LSB
}

TEST_CASE("ADC: missing codes never occur, those beside them share their range") {
  ConverterSpec spec{0, 16, 4};
  spec.missing_codes = {7, 0, 8, 15};
  const auto q = quantiser(spec);
  std::set<double> seen;
  for (int i = -100; i < 1700; ++i) seen.insert(q.convert(0.01 * i).value);
  CHECK(seen == std::set<double>{1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 13, 14});
  CHECK(q.convert(7.4).value == 6);
  CHECK(q.convert(7.6).value == 9);
}

TEST_CASE("ADC: characteristics that can't be are refused") {
  const auto error = [](const ConverterSpec& spec) {
    const auto q = Quantiser::make(spec);
    return q ? "made" : q.error().text;
  };
  CHECK(error({1, 1}) == "the range 1 to 1 does not rise");
  CHECK(error({-1, 1, {}, 0, 0, {3}}) == "missing codes without bits");
  CHECK(error({-1, 1, {}, 0, 0, {}, {0, 1}}) == "an integral nonlinearity without bits; it counts in LSB");
  CHECK(error({-1, 1, 3, 0, 0, {8}}) == "missing code 8; codes are 0 to 7");
  CHECK(error({-1, 1, 1, 0, 0, {0, 1}}) == "all codes are missing");
  CHECK(error({-1, 1, 3, 0, 0, {}, {1}}) == "an integral nonlinearity of one point; at least two, over the range");
}

TEST_CASE("ADC: rounding a busy signal adds noise of LSB^2 / 12") {
  const auto q = quantiser({-1, 1, 10});
  numerics::Random random(7);
  double sum = 0.0;
  constexpr int kSamples = 100000;
  for (int n = 0; n < kSamples; ++n) {
    const double v = 0.2 * random.normal(), e = q.convert(v).value - v;
    sum += e * e;
  }
  // The variance of e^2 is LSB^4 / 180: 5 standard deviations are 1.4 %.
  CHECK(sum / kSamples == Approx(q.step() * q.step() / 12).epsilon(0.014));
}

TEST_CASE("ADC: a full-scale sine stands 6.02 bits + 1.76 dB above the rounding noise") {
  for (const int bits : {8, 12, 16}) {
    BlockDriver<Adc> adc;
    adc.set("factor", std::int64_t{1}).set("range", std::vector<double>{-1, 1}).set("bits", std::int64_t{bits});
    std::vector<double> x(16384);
    const double amplitude = 1.0 - 1.0 / std::ldexp(1.0, bits - 1);
    for (std::size_t n = 0; n < x.size(); ++n)
      x[n] = amplitude * std::sin(kTurn * 1021.0 * static_cast<double>(n) / 16384.0 + 0.1);
    INFO(bits);
    const double full_scale = 20 * std::log10(amplitude);
    CHECK(signal_to_noise(convert(adc, x, 1, 1e4), 1021) == Approx(6.02 * bits + 1.76 + full_scale).margin(0.3));
  }
}

TEST_CASE("ADC: aperture jitter limits a sine to -20 log10(2 pi f sigma) dB") {
  constexpr std::int64_t kFactor = 16;
  constexpr double kRate = 16e5, kSigma = 2e-8;
  for (const Eigen::Index line : {Eigen::Index{401}, Eigen::Index{2003}}) {
    BlockDriver<Adc> adc;
    adc.set("factor", kFactor).set("range", std::vector<double>{-2, 2}).set("jitter", kSigma);
    std::vector<double> x(8192 * kFactor);
    const double f = static_cast<double>(line) * 1e5 / 8192;
    for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::sin(kTurn * f * static_cast<double>(n) / kRate);
    INFO(f);
    // 8192 squares of noise: 5 standard deviations are 0.35 dB.
    CHECK(signal_to_noise(convert(adc, x, kFactor, kRate), line) == Approx(-20 * std::log10(kTurn * f * kSigma)).margin(0.35));
  }
}

TEST_CASE("ADC: without jitter every factor-th sample is taken as it is, and with it the cubic is exact for cubics") {
  std::vector<double> x(40);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::pow(0.1 * static_cast<double>(n) - 1, 3);
  ApertureSampler sampler(8, 5);
  std::vector<double> y(5);
  sampler.run(x, {}, y);
  CHECK(y[3] == x[24]);
  sampler.run(x, std::vector<double>{0.5, -0.25, 1.75, -4.5, 4.9}, y);
  CHECK(y[1] == Approx(std::pow(0.775 - 1, 3)).epsilon(1e-12));
  CHECK(y[2] == Approx(std::pow(1.775 - 1, 3)).epsilon(1e-12));
  CHECK(y[3] == Approx(std::pow(1.95 - 1, 3)).epsilon(1e-12));
  CHECK(y[4] == Approx(std::pow(3.69 - 1, 3)).epsilon(1e-12));
}

TEST_CASE("ADC: the anti-alias filter is 3 dB down at its corner, 6 dB an octave and order beyond") {
  constexpr double kRate = 1e5, kCorner = 500.0;
  for (const int order : {1, 2, 4, 7}) {
    for (const double octaves : {-2.0, 0.0, 2.0}) {
      BlockDriver<Adc> adc;
      adc.set("factor", std::int64_t{10}).set("range", std::vector<double>{-10, 10});
      adc.set("filter.order", std::int64_t{order}).set("filter.corner", kCorner);
      const double f = kCorner * std::pow(2.0, octaves);
      std::vector<double> x(60000);
      for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::sin(kTurn * f * static_cast<double>(n) / kRate);
      const auto y = convert(adc, x, 10, kRate);
      std::complex<double> line = 0;
      for (std::size_t m = 2000; m < 6000; ++m) line += y[m] * std::polar(1.0, -kTurn * f * static_cast<double>(m) * 10 / kRate);
      const double droop = std::sin(M_PI * f / kRate) / (M_PI * f / kRate);  // of the held input
      INFO("order " << order << ", " << f << " Hz");
      // Images of the held input reach the output through the filter.
      CHECK(std::abs(line) / 2000 / droop == Approx(1 / std::sqrt(1 + std::pow(f / kCorner, 2 * order))).epsilon(2e-3));
    }
  }
}

TEST_CASE("ADC: clipped samples are counted exactly and told at the end") {
  BlockDriver<Adc> adc;
  adc.set("factor", std::int64_t{2}).set("range", std::vector<double>{-1, 1});
  const std::vector<double> x = {0.5, 9, 1.0, 9, 1.001, 0, -2, 0, -1, 0, 0, 0};
  CHECK(convert(adc, x, 2, 1000) == std::vector<double>{0.5, 1, 1, -1, -1, 0});
  adc.finish();
  CHECK(adc.log() ==
        std::vector<std::string>{"warning: clipped 2 of 6 samples (33.3333 %), the first at sample 2 of channel 1; range "
                                 "-1 to 1 V: widen it or lower the signal"});
  adc.reset();
  adc.finish();
  CHECK(adc.log().size() == 1);
}

TEST_CASE("ADC: channels are sampled at the same instants") {
  BlockDriver<Adc> adc;
  adc.set("factor", std::int64_t{8}).set("range", std::vector<double>{-2, 2}).set("jitter", 1e-4);
  adc.configure();
  adc.resolve({stream(1000, 2)});
  adc.activate(50, Rate(125, 1));
  std::vector<double> x(400), twice;
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::sin(0.1 * static_cast<double>(n));
  for (const double v : x) twice.push_back(0.5 * v);
  const auto y = adc.process({{x, twice}}, 50)[0];
  CHECK(y[0][30] != x[240]);
  for (std::size_t m = 0; m < 50; ++m) CHECK(y[1][m] == 0.5 * y[0][m]);
}

TEST_CASE("ADC: what does not fit is refused, and a value that is not finite is named") {
  const auto failure = [](const std::function<void(BlockDriver<Adc>&)>& set) {
    BlockDriver<Adc> adc;
    adc.set("factor", std::int64_t{4}).set("range", std::vector<double>{-1, 1});
    set(adc);
    return failure_of([&] {
      adc.configure();
      adc.resolve({stream(1000)});
    });
  };
  CHECK(failure([](auto& b) { b.set("range", std::vector<double>{1}); }) ==
        "range has 1 values; allowed: two, lowest and highest");
  CHECK(failure([](auto& b) { b.set("filter.order", std::int64_t{2}); }) ==
        "filter.order without filter.corner, its -3 dB frequency");
  CHECK(failure([](auto& b) { b.set("filter.corner", 5.0); }) == "filter.corner without filter.order; allowed: 1 to 12");
  CHECK(failure([](auto& b) { b.set("filter.order", std::int64_t{2}).set("filter.corner", 600.0); }) ==
        "filter.corner 600 Hz; below half the input rate, 500 Hz");
  CHECK(failure([](auto& b) { b.set("jitter", 1e-3); }) ==
        "jitter 0.001 s with factor 4 at an input rate of 1000 Hz; at most (factor - 3) / 8.3 input intervals, 0.000120482 s");
  BlockDriver<Adc> adc;
  adc.set("factor", std::int64_t{2}).set("range", std::vector<double>{-1, 1});
  CHECK(failure_of([&] {
          convert(adc, {0, 1, 2, std::nan("")}, 2, 1000);
        }) == "sample 3 of channel 1 is nan; a converter takes finite values");
}

TEST_CASE("ADC: check tells the LSB and warns of lines that fold down, by what they are weakened") {
  BlockDriver<Adc> adc;
  adc.set("factor", std::int64_t{10}).set("range", std::vector<double>{-1, 1}).set("bits", std::int64_t{10}).set("jitter", 1e-6);
  adc.set("filter.order", std::int64_t{2}).set("filter.corner", 100.0);
  adc.configure();
  StreamFacts x = stream(10000);
  x.notes["excitation.frequencies"] = {10, 600, 700};
  CHECK(adc.advise({x}) == std::vector<std::string>{
                               "LSB 0.00195312 V, rounding noise 0.000563819 V rms",
                               "jitter limits a line at 700 Hz to 47.1344 dB above its noise",
                               "warning: the line at 600 Hz is above half the output rate and folds down to 400 Hz, weakened by "
                               "31.1294 dB; set filter.order and filter.corner, or excite lower lines"});
  CHECK(adc.resolve({x})[0].notes["noise.std"][0] == Approx(0.001953125 / std::sqrt(12.0)));
}
