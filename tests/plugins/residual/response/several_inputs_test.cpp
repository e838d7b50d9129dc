#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/random.hpp>
#include <bodeflow/record_builder.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "../declared_base.hpp"
#include "bases/frequency_response.hpp"
#include "catch.hpp"
#include "linear_effects.hpp"
#include "periodic/periodic_measurement.hpp"
#include "records/response.hpp"
#include "trace/trace.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

/// A plant of three inputs and three outputs, known by its measured response alone: two periods an experiment, all lines excited,
/// as a piezo mirror is measured.
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kRate = 6400.0;
constexpr Eigen::Index kPeriod = 1024, kLines = 400, kPeriods = 2;
constexpr double kNoise = 2e-3;

Complex mirror(int input, double f) {
  const Complex s(0.0, kTwoPi * f);
  const double w1 = kTwoPi * (700.0 + 40.0 * input), w2 = kTwoPi * 1500.0;
  return (1.0 + 0.2 * input) * w1 * w1 / (s * s + 0.04 * w1 * s + w1 * w1) +
         (0.5 - 0.4 * input) * w2 * w2 / (s * s + 0.05 * w2 * s + w2 * w2);
}

std::shared_ptr<const FrequencyResponseModel> base() {
  records::ResponseData data;
  data.form = "known_input";
  data.input_names = {"u1", "u2", "u3"};
  data.output_names = {"y1", "y2", "y3"};
  data.response_units = std::vector<std::string>(9, "um/V");
  data.frequency_hz.resize(kLines);
  data.response.resize(kLines, 9);
  for (Eigen::Index k = 0; k < kLines; ++k) {
    data.frequency_hz[k] = static_cast<double>(k + 1) * kRate / kPeriod;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) data.response(k, 3 * i + j) = (i + 1.0) * mirror(j, data.frequency_hz[k]);
  }
  const RecordBuilder record = records::write_response(data);
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };
  std::vector<Line> memory(static_cast<std::size_t>(record.size()) / sizeof(Line));
  record.write(memory.data());
  FrequencyResponseModel made = *declared_base<FrequencyResponseModel>({{"output", std::string("y1")}});
  made.use_model(RecordView(memory.front().bytes));
  return std::make_shared<const FrequencyResponseModel>(made);
}

/// An experiment at that level; the factor is what the plant does besides, `map` what its sensor makes of the output.
records::Recording experiment(std::uint64_t seed, double level, const std::function<Complex(Complex s)>& factor,
                              const std::function<double(double)>& map) {
  numerics::Random random(seed);
  records::Recording r;
  r.sample_rate_hz = kRate;
  r.period = kPeriod;
  r.periods = kPeriods;
  r.input_signals = {{"u1", "u2", "u3"}, {"V", "V", "V"}};
  r.output_signals = {{"y1"}, {"um"}};
  r.input.resize(kPeriods * kPeriod, 3);
  r.output.resize(kPeriods * kPeriod, 1);
  Eigen::VectorXcd output = Eigen::VectorXcd::Zero(kPeriod);
  for (int j = 0; j < 3; ++j) {
    Eigen::VectorXcd input = Eigen::VectorXcd::Zero(kPeriod);
    for (Eigen::Index k = 1; k <= kLines; ++k) {
      const double f = static_cast<double>(k) * kRate / kPeriod;
      input[k] = std::polar(level * static_cast<double>(kPeriod) / 40.0, kTwoPi * random.uniform());
      input[kPeriod - k] = std::conj(input[k]);
      const Complex y = mirror(j, f) * factor({0.0, kTwoPi * f}) * input[k];
      output[k] += y;
      output[kPeriod - k] += std::conj(y);
    }
    r.input.col(j) = numerics::inverse_dft(input).real().replicate(kPeriods, 1);
  }
  const Eigen::VectorXd y = numerics::inverse_dft(output).real();
  for (Eigen::Index n = 0; n < kPeriods * kPeriod; ++n) r.output(n, 0) = map(y[n % kPeriod]) + kNoise * random.normal();
  return r;
}

Trace traced(std::uint64_t seed, const std::function<Complex(Complex s)>& factor, const std::function<double(double)>& map) {
  const auto model = base();
  const auto measured = [&](const char* name, double level) {
    const auto m = periodic_measurement(experiment(++seed, level, factor, map), name, {}, *model);
    INFO((m ? "" : m.error().text));
    REQUIRE(m);
    return *m;
  };
  TraceData data;
  data.fit = {measured("fit 1", 0.1), measured("fit 2", 0.3)};
  data.select = measured("select", 0.25);
  data.test = measured("test", 0.3);
  Catalogue catalogue;
  for (const testing::Linear& e : testing::linear_effects()) catalogue.push_back({e.what, e.effect});
  auto t = trace(model, catalogue, data, {});
  INFO((t ? "" : t.error().text));
  REQUIRE(t);
  return std::move(*t);
}

Complex nothing(Complex) { return 1.0; }
double as_it_is(double y) { return y; }

}  // namespace

TEST_CASE("several inputs: a measured response as the base model lacks nothing where nothing is missing") {
  const Trace t = traced(100, nothing, as_it_is);
  CHECK(t.verdict == Verdict::none);
  CHECK(t.after.at_floor());
}

TEST_CASE("several inputs: a delay beside a measured response is named") {
  const Trace t = traced(
      200, [](Complex s) { return std::exp(-20e-6 * s); }, as_it_is);
  REQUIRE(t.searched.found.size() == 1);
  CHECK(t.searched.found.front().addition.name() == "delay");
  CHECK(t.searched.best.fit.values()[3] == Approx(20e-6).margin(4.0 * t.searched.best.fit.std()[3]));
  CHECK(t.after.at_floor());
}

TEST_CASE("several inputs: what is nonlinear stays unexplained by effects that are linear") {
  const Trace t = traced(300, nothing, [](double y) { return y + 0.05 * y * y * y; });
  CHECK(t.verdict == Verdict::unexplained);
  CHECK_FALSE(t.before.at_floor());
}
