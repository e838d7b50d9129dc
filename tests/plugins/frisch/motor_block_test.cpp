#include "frisch/motor_block.hpp"

#include <Eigen/Dense>

#include "catch.hpp"
#include "frisch/known_motor_block.hpp"
#include "frisch/noise_block.hpp"
#include "plugins/block_driver.hpp"
#include "records.hpp"
#include "records/model.hpp"
#include "records/response.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using frisch::KnownMotor;
using frisch::Motor;
using frisch::Noise;

namespace {

struct TwoBands {
  MotorBand low = low_band(1.0), high = high_band(0.85);
  numerics::Random random{5};
  MotorRecord low_record = motor_record(low, random), high_record = motor_record(high, random);
};

StreamFacts stream(const char* unit, double rate_hz, int channels = 1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(rate_hz);
  f.unit = unit;
  return f;
}

void start(BlockDriver<Motor>& block, double rate_hz = 250.0) {
  block.configure();
  block.resolve({stream("V", rate_hz), stream("A", rate_hz)});
  block.activate(4096, Rate::from_hz(rate_hz));
}

void start_without_streams(BlockDriver<Motor>& block) {
  block.configure();
  block.resolve({StreamFacts{}, StreamFacts{}});
  block.activate(1, Rate(1, 1));
}

std::vector<Channels> samples(const MotorRecord& r) {
  return {Channels{{r.voltage.begin(), r.voltage.end()}}, Channels{{r.current.begin(), r.current.end()}}};
}

Eigen::Vector4d parameters(const BlockDriver<Motor>& block) {
  REQUIRE(block.records().size() == 4);
  return records::read_model(RecordView(*block.records()[0]))->parameters;
}

Eigen::Vector4d estimated(const std::string& method, bool matrices, const TwoBands& t) {
  BlockDriver<Motor> block;
  block.set("method", method).set("correlated_noise", false);
  start_without_streams(block);
  if (matrices) {
    // The driver has one message port; the algorithms are called as the block calls them.
    const AlignedRecord low(matrix_record(t.low_record, t.low, 16)), high(matrix_record(t.high_record, t.high, 16));
    frisch::MotorSettings settings;
    settings.method = method == "frisch" ? frisch::Method::frisch : frisch::Method::none;
    return frisch::estimate_motor({*frisch::band_of_matrix(high.view()), *frisch::band_of_matrix(low.view())}, settings)
        ->fit.model.vector();
  }
  block.receive(response_record(t.low_record, t.low), 0.0);
  block.receive(response_record(t.high_record, t.high), 0.0);
  block.finish();
  return parameters(block);
}

}  // namespace

TEST_CASE("frisch.motor: two responses give the model that the algorithms give from the windows") {
  const TwoBands t;
  const auto expected = frisch::fit_motor_likelihood(frisch::joined(means(t.low_record, t.low), means(t.high_record, t.high)));
  REQUIRE(expected);
  CHECK(estimated("maximum_likelihood", false, t).isApprox(expected->model.vector(), 1e-8));
  const auto by_frisch = [&](bool corrected) {
    const auto response = [&](const MotorRecord& r, const MotorBand& band) {
      const auto w = windows(r, band, 16);
      const auto p = *frisch::power_spectra(w.input, w.output);
      return *frisch::corrected_response(p, corrected ? frisch::frisch_noise(p)->second : frisch::NoiseVariances{},
                                         frisch::ResponseForm::output);
    };
    const Eigen::VectorXcd g = stacked(response(t.low_record, t.low), response(t.high_record, t.high));
    return Eigen::Vector4d(
        frisch::fit_motor(stacked(t.low.omega(), t.high.omega()), g, Eigen::VectorXd::Ones(48))->model.vector());
  };
  CHECK(estimated("frisch", true, t).isApprox(by_frisch(true), 1e-8));
  CHECK(estimated("none", true, t).isApprox(by_frisch(false), 1e-8));
}

TEST_CASE("frisch.motor: the record carries covariance, intervals, poles and what it came from") {
  const TwoBands t;
  BlockDriver<Motor> block;
  start_without_streams(block);
  block.receive(response_record(t.low_record, t.low), 0.0);
  block.receive(response_record(t.high_record, t.high), 0.0);
  block.finish();
  const RecordView record(*block.records()[0]);
  const auto model = records::read_model(record);
  REQUIRE(model);
  CHECK(model->method == "frisch.motor");
  CHECK(model->form == "physical");
  CHECK(model->parameter_names == std::vector<std::string>{"gamma", "alpha", "Lm_beta", "sigma"});
  CHECK(model->expected_cost == 46.0);
  CHECK(*model->cost == Approx(46.0).margin(25.0));
  CHECK(model->input_unit == "V");
  CHECK(model->output_unit == "A");
  CHECK(model->samples == 2048);
  CHECK(model->warnings.empty());
  // Peak of 24 lines of 1 V with the phases of the paper.
  CHECK(*model->input_amplitude == Approx(t.low_record.voltage.cwiseAbs().maxCoeff()).epsilon(0.35));
  // Poles and zero are roots of the polynomials; the variance of the zero is alpha's.
  for (const auto& p : model->poles) {
    const auto value = p * p * model->denominator[0] + p * model->denominator[1] + model->denominator[2];
    CHECK(std::abs(value) < 1e-9 * std::abs(p * p));
  }
  CHECK(std::abs(model->zeros[0] + model->parameters[1]) < 1e-12);
  CHECK(record.array("zero_covariance")->as<double>()[0] == Approx(model->covariance(1, 1)));
  // The slope of a pole against finite differences of its own formula.
  const auto pole = [&](const Eigen::Vector4d& p, double sign) {
    const double sum = p[0] + p[1], product = p[1] * (p[0] - p[1] * p[2]);
    return -0.5 * (sum + sign * std::sqrt(sum * sum - 4.0 * product));
  };
  for (const int i : {0, 1}) {
    Eigen::Vector4d slope;
    for (Eigen::Index j = 0; j < 4; ++j) {
      Eigen::Vector4d up = model->parameters, down = up;
      const double h = 1e-6 * up[j];
      up[j] += h;
      down[j] -= h;
      slope[j] = (pole(up, i == 0 ? -1.0 : 1.0) - pole(down, i == 0 ? -1.0 : 1.0)) / (2.0 * h);
    }
    const double variance = record.array("pole_covariance")->as<double>()[static_cast<std::size_t>(4 * i)];
    CHECK(variance == Approx(slope.dot(model->covariance * slope)).epsilon(1e-5));
  }
  const auto low = record.array("interval_low")->as<double>(), high = record.array("interval_high")->as<double>();
  for (std::size_t i = 0; i < 4; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    CHECK(low[i] < model->parameters[at]);
    CHECK(high[i] > model->parameters[at]);
  }
  const auto noise = record.array("output_noise_std")->as<double>();
  CHECK(noise[0] == Approx(0.22).epsilon(0.15));
  CHECK(noise[1] == Approx(0.117).epsilon(0.15));
  const RecordView terminals(*block.records()[1]), circuit(*block.records()[2]);
  CHECK(terminals.array("parameters")->as<double>()[0] == Approx(6.6).epsilon(0.15));
  CHECK(circuit.text("assumption")->substr(0, 7) == "Ls = Lr");
  const auto fitted = records::read_response(RecordView(*block.records()[3]));
  REQUIRE(fitted);
  CHECK(fitted->frequency_hz.size() == 48);
  CHECK(fitted->response_units.front() == "A/V");
  CHECK(fitted->degrees_of_freedom.value() == Approx(336.0));
}

TEST_CASE("frisch.motor: streams give what their response gives, with the lines found or named") {
  const TwoBands t;
  BlockDriver<Motor> from_record;
  start_without_streams(from_record);
  from_record.receive(response_record(t.high_record, t.high), 0.0);
  from_record.finish();
  for (const bool named : {false, true}) {
    BlockDriver<Motor> block;
    block.set("period", std::int64_t{128});
    if (named) block.set("lines.first", std::int64_t{3}).set("lines.last", std::int64_t{49}).set("lines.step", std::int64_t{2});
    start(block);
    block.process(samples(t.high_record), 1024);
    block.finish();
    CHECK(parameters(block).isApprox(parameters(from_record), 1e-8));
  }
}

TEST_CASE("frisch.motor: a held command with hold given finds the motor, and says what is wrong without") {
  // Every twentieth sample of a staircase of 200 us steps, and of the exact currents, with little noise.
  const MotorBand band = high_band(20.0);
  numerics::Random random(1);
  MotorRecord r;
  const frisch::MotorModel truth = paper_motor();
  const Eigen::VectorXd omega = band.omega();
  r.voltage = r.current = Eigen::VectorXd::Zero(1024);
  for (std::size_t i = 0; i < band.lines.size(); ++i) {
    const auto g = frisch::held_response(truth, omega[static_cast<Eigen::Index>(i)], 200e-6);
    const double phase = 2.7 * static_cast<double>(i * i);
    for (Eigen::Index n = 0; n < 1024; ++n) {
      const double angle = omega[static_cast<Eigen::Index>(i)] * 0.004 * static_cast<double>(n) + phase;
      r.voltage[n] += 20.0 * std::cos(angle);
      r.current[n] += 20.0 * (g * std::polar(1.0, angle)).real();
    }
  }
  for (double& y : r.current) y += 1e-4 * random.normal();
  for (const bool held : {true, false}) {
    BlockDriver<Motor> block;
    block.set("input_is", std::string("command")).set("hold", held ? 200e-6 : 0.0);
    start_without_streams(block);
    block.receive(response_record(r, band), 0.0);
    block.finish();
    const auto model = records::read_model(RecordView(*block.records()[0]));
    REQUIRE(model);
    const Eigen::Vector4d relative = model->parameters.cwiseQuotient(truth.vector()) - Eigen::Vector4d::Ones();
    CAPTURE(relative.transpose());
    if (held) {
      CHECK(model->warnings == std::vector<std::string>{});
      CHECK((relative.array().abs() < 5.0 * model->covariance.diagonal().array().sqrt() / truth.vector().array()).all());
      CHECK(relative.cwiseAbs().maxCoeff() < 1e-3);
    } else {
      REQUIRE(model->warnings.size() >= 2);
      CHECK(model->warnings.front().find("the motor has something that the model lacks") != std::string::npos);
      CHECK(model->warnings.back().substr(0, 43) == "the input is the command and `hold` is 0: h");
      CHECK(relative.cwiseAbs().maxCoeff() > 0.02);
    }
  }
}

TEST_CASE("frisch.motor: what cannot work is refused by name") {
  const TwoBands t;
  CHECK(failure_of([] {
          BlockDriver<Motor> block;
          start_without_streams(block);
          block.finish();
        }) == "nothing was measured: connect `response`, `matrix`, or the streams `input` and `output`");
  CHECK(failure_of([] {
          BlockDriver<Motor> block;
          start(block);
        }) == "period is needed for the streams: samples in one period of the excitation");
  CHECK(failure_of([] {
          BlockDriver<Motor> block;
          block.set("period", std::int64_t{128});
          block.configure();
          block.resolve({stream("V", 250.0, 2), stream("A", 250.0)});
        }) == "input 'input' has 2 channels; needed: one, the axis that is driven");
  CHECK(failure_of([] {
          BlockDriver<Motor> block;
          block.set("period", std::int64_t{128}).set("lines.first", std::int64_t{3}).set("lines.last", std::int64_t{64});
          block.configure();
        }) == "lines: from 3 to 64; allowed: rising, at most 63 with a period of 128");
  CHECK(failure_of([&] {
          BlockDriver<Motor> block;
          block.set("period", std::int64_t{128}).set("skip", std::int64_t{7});
          start(block);
          block.process(samples(t.high_record), 1024);
          block.finish();
        }) == "1024 samples; needed: 7 skipped periods and 2 more of 128");
  CHECK(failure_of([&] {
          BlockDriver<Motor> block;
          block.set("period", std::int64_t{128});
          start(block);
          auto bad = samples(t.high_record);
          bad[1][0][17] = std::nan("");
          block.process(bad, 1024);
        }) == "output: sample 17 is not a number");
  CHECK(failure_of([&] {
          BlockDriver<Motor> block;
          block.set("band", std::string("1 kHz:2 kHz"));
          start_without_streams(block);
          block.receive(response_record(t.low_record, t.low), 0.0);
          block.finish();
        }) == "the band 1000 to 2000 Hz holds none of the lines from 0.122 to 5.74 Hz");
}

TEST_CASE("frisch.noise: both passes and the pooled noise of each band, with the lines left out") {
  const TwoBands t;
  BlockDriver<Noise> block;
  block.configure();
  block.resolve({});
  block.activate(1, Rate(1, 1));
  block.receive(matrix_record(t.high_record, t.high, 16), 0.0);
  block.receive(matrix_record(t.low_record, t.low, 16), 0.0);
  block.finish();
  REQUIRE(block.records().size() == 1);
  const RecordView r(*block.records()[0]);
  const auto value = [&](const char* name, std::size_t band) { return r.array(name)->as<double>()[band]; };
  std::size_t band = 0;
  for (const auto& [record, of] : {std::pair{&t.low_record, &t.low}, std::pair{&t.high_record, &t.high}}) {
    const auto w = windows(*record, *of, 16), whole = windows(*record, *of, 128);
    const auto noise = *frisch::frisch_noise(*frisch::power_spectra(w.input, w.output));
    const auto pooled = *frisch::pooled_noise(whole.input, whole.output);
    CHECK(value("input_first", band) == Approx(std::sqrt(noise.first.input)));
    CHECK(value("output_second", band) == Approx(std::sqrt(noise.second.output)));
    CHECK(value("input_pooled", band) == Approx(std::sqrt(pooled.input_variance)));
    CHECK(value("output_pooled", band) == Approx(std::sqrt(pooled.output_variance)));
    ++band;
  }
  CHECK(r.array("removed_frequency")->size == 4);
  // Every curve of (12) ends on both axes at the limits (13), and no curve passes below the first estimate.
  const auto most_output = r.array("largest_output")->as<double>(), curve = r.array("curve_output")->as<double>(),
             along = r.array("curve_input")->as<double>();
  const std::size_t points = r.array("curve_output")->shape[1];
  for (std::size_t k = 0; k < 48; ++k) {
    CHECK(curve[k * points] == Approx(most_output[k]));
    CHECK(curve[k * points + points - 1] == Approx(0.0).margin(1e-9 * most_output[k]));
    CHECK(along[k * points + points - 1] == Approx(r.array("largest_input")->as<double>()[k]));
  }
  CHECK(failure_of([] {
          BlockDriver<Noise> empty;
          empty.configure();
          empty.resolve({});
          empty.activate(1, Rate(1, 1));
          empty.finish();
        }) == "no record arrived at `matrix`");
}

TEST_CASE("frisch.known_motor: the paper's motor, and an estimate beside it") {
  const TwoBands t;
  BlockDriver<Motor> motor;
  start_without_streams(motor);
  motor.receive(response_record(t.low_record, t.low), 0.0);
  motor.receive(response_record(t.high_record, t.high), 0.0);
  motor.finish();
  const auto estimate = records::read_model(RecordView(*motor.records()[0]));
  BlockDriver<KnownMotor> known;
  for (const auto& [name, value] :
       std::map<std::string, double>{{"rs", 6.6}, {"rr", 5.5}, {"ls", 0.475}, {"lr", 0.475}, {"lm", 0.454}})
    known.set(name, value);
  known.configure();
  known.resolve({});
  known.activate(1, Rate(1, 1));
  known.receive(records::write_model(*estimate), 0.0);
  known.finish();
  REQUIRE(known.records().size() == 2);
  const auto model = records::read_model(RecordView(*known.records()[0]));
  REQUIRE(model);
  CHECK(model->parameters.isApprox(paper_motor().vector(), 1e-14));
  CHECK(model->poles[0].real() == Approx(-6.45732).epsilon(1e-5));
  CHECK(model->poles[1].real() == Approx(-288.1503).epsilon(1e-5));
  const RecordView table(*known.records()[1]);
  const auto off = table.array("deviation_over_std")->as<double>();
  for (std::size_t i = 0; i < 4; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    CHECK(off[i] == Approx((estimate->parameters[at] - model->parameters[at]) / std::sqrt(estimate->covariance(at, at))));
    CHECK(std::abs(off[i]) < 4.0);
  }
  CHECK(failure_of([] {
          BlockDriver<KnownMotor> impossible;
          for (const auto& [name, value] :
               std::map<std::string, double>{{"rs", 6.6}, {"rr", 5.5}, {"ls", 0.4}, {"lr", 0.4}, {"lm", 0.4}})
            impossible.set(name, value);
          impossible.configure();
        }).find("Lm") != std::string::npos);
}
