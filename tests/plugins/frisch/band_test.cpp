// What arrives as records gives the same noise and the same estimates as the windows themselves.

#include "frisch/band.hpp"

#include "catch.hpp"
#include "frisch/excited_lines.hpp"
#include "frisch/motor_estimate.hpp"
#include "records.hpp"

using namespace bodeflow;
using namespace bodeflow::frisch;
using numerics::Random;
using test::AlignedRecord;

namespace {

constexpr double kRounding = 1e-12;

struct Measured {
  test::MotorBand band = test::low_band(1.0);
  Random random{11};
  test::MotorRecord record = test::motor_record(band, random);
  test::WindowSpectra whole = test::windows(record, band, 128);
};

void check_same(const PooledNoise& a, const PooledNoise& b) {
  CHECK(a.input_variance == Approx(b.input_variance).epsilon(kRounding));
  CHECK(a.output_variance == Approx(b.output_variance).epsilon(kRounding));
  CHECK(std::abs(a.covariance - b.covariance) < kRounding * std::sqrt(b.input_variance * b.output_variance));
  CHECK(a.degrees_of_freedom == Approx(b.degrees_of_freedom));
}

void check_same(const PowerSpectra& a, const PowerSpectra& b) {
  CHECK(a.uu.isApprox(b.uu, kRounding));
  CHECK(a.yy.isApprox(b.yy, kRounding));
  CHECK(a.yu.isApprox(b.yu, kRounding));
}

std::string refusal(const RecordBuilder& record, bool matrix = false) {
  const AlignedRecord bytes(record);
  const auto band = matrix ? band_of_matrix(bytes.view()) : band_of_response(bytes.view());
  return band ? "accepted" : band.error().text;
}

}  // namespace

TEST_CASE("frisch: noise pooled from a response's variances is that of the windows") {
  const Measured m;
  const AlignedRecord record(test::response_record(m.record, m.band));
  const auto band = band_of_response(record.view());
  REQUIRE(band);
  check_same(pooled_noise(*band), *frisch::pooled_noise(m.whole.input, m.whole.output));
  check_same(band->power, *power_spectra(m.whole.input, m.whole.output));
  CHECK(band->mean.omega.isApprox(m.band.omega(), kRounding));
  CHECK(band->input_name == "voltage");
  CHECK(band->output_unit == "A");
  const auto expected =
      *mean_spectra(m.band.omega(), m.whole.input, m.whole.output, *frisch::pooled_noise(m.whole.input, m.whole.output), true);
  const MeanSpectra found = with_pooled_noise(*band, true);
  CHECK(found.input.isApprox(expected.input, kRounding));
  CHECK(found.output.isApprox(expected.output, kRounding));
  CHECK(found.input_variance.isApprox(expected.input_variance, kRounding));
  CHECK(found.output_variance.isApprox(expected.output_variance, kRounding));
  CHECK((found.covariance - expected.covariance).norm() <
        1e-10 * std::sqrt(expected.input_variance[0] * expected.output_variance[0]));
}

TEST_CASE("frisch: a spectral matrix gives the products of its windows, and noise and means of whole periods") {
  const Measured m;
  const AlignedRecord record(test::matrix_record(m.record, m.band, 16));
  const auto band = band_of_matrix(record.view());
  REQUIRE(band);
  const auto overlapping = test::windows(m.record, m.band, 16);
  check_same(band->power, *power_spectra(overlapping.input, overlapping.output));
  check_same(pooled_noise(*band), *frisch::pooled_noise(m.whole.input, m.whole.output));
  CHECK(band->windows == 57.0);
  CHECK(band->periods == 8.0);
}

TEST_CASE("frisch: a band of samples is the band of their response and their matrix") {
  const Measured m;
  const auto band = band_of_samples(m.record.voltage, m.record.current, 128, 16, m.band.lines, 1.0 / m.band.sample_time);
  REQUIRE(band);
  const AlignedRecord response(test::response_record(m.record, m.band)), matrix(test::matrix_record(m.record, m.band, 16));
  const auto a = band_of_response(response.view()), b = band_of_matrix(matrix.view());
  check_same(pooled_noise(*band), pooled_noise(*a));
  check_same(band->power, b->power);
  CHECK(band->mean.input.isApprox(a->mean.input, kRounding));
  CHECK(band->mean.output_variance.isApprox(a->mean.output_variance, kRounding));
}

TEST_CASE("frisch: noise alike at all lines passes the flatness test at its rate, noise that is not fails it") {
  test::MotorBand band = test::high_band(0.85);
  Random random(3);
  int rejected = 0;
  constexpr int kSets = 400;
  for (int set = 0; set < kSets; ++set) {
    const auto r = test::motor_record(band, random);
    const auto b = *band_of_samples(r.voltage, r.current, 128, 128, band.lines, 250.0);
    rejected += noise_flatness(b) < 0.1 ? 1 : 0;
  }
  CHECK(rejected > 0.1 * kSets - 4.0 * std::sqrt(0.09 * kSets));
  CHECK(rejected < 0.1 * kSets + 4.0 * std::sqrt(0.09 * kSets));
  auto r = test::motor_record(band, random);
  for (Eigen::Index t = 1; t < r.current.size(); ++t) r.current[t] += 0.9 * (r.current[t - 1] - r.current[t] * 0.5);
  CHECK(noise_flatness(*band_of_samples(r.voltage, r.current, 128, 128, band.lines, 250.0)) < 1e-4);
}

TEST_CASE("frisch: the lines that a multisine excites are found from its samples") {
  const Measured m;
  const auto lines = excited_lines(m.record.voltage, 128);
  REQUIRE(lines);
  CHECK(*lines == m.band.lines);
  const auto constant = excited_lines(Eigen::VectorXd::Constant(256, 0.0), 128);
  REQUIRE_FALSE(constant);
  CHECK(constant.error().text == "the signal is constant: it excites no line");
}

TEST_CASE("frisch: a part of a band keeps the lines within, ends included") {
  const Measured m;
  const AlignedRecord record(test::response_record(m.record, m.band));
  const auto band = *band_of_response(record.view());
  const auto part = part_of(band, band.mean.omega[3], band.mean.omega[9]);
  REQUIRE(part);
  CHECK(part->mean.omega == band.mean.omega.segment(3, 7));
  CHECK(part->power.yu == band.power.yu.segment(3, 7));
  const auto none = part_of(band, 1000.0, 2000.0);
  REQUIRE_FALSE(none);
  CHECK(none.error().text == "the band 159.155 to 318.31 Hz holds none of the lines from 0.122 to 5.74 Hz");
}

TEST_CASE("frisch: records that tell too little are refused by what is missing") {
  const Measured m;
  CHECK(refusal(RecordBuilder("model")) == "a record of type 'model'; needed: frequency_response");
  CHECK(refusal(RecordBuilder("model"), true) == "a record of type 'model'; needed: spectral_matrix");
  RecordBuilder bare("frequency_response");
  bare.array<double>("frequency", "Hz", {1})[0] = 1.0;
  RecordBuilder two = bare;
  two.array<std::complex<double>>("response", "", {1, 2, 1})[0] = 1.0;
  CHECK(refusal(two) == "the response has 1 input and 2 outputs; the motor at standstill has one of each");
  bare.array<std::complex<double>>("response", "", {1, 1, 1})[0] = 1.0;
  CHECK(refusal(bare) ==
        "the response has neither mean spectra nor a variance; measure it by spectrum.averaging_dft over 2 periods or more");
  RecordBuilder matrix("spectral_matrix");
  CHECK(refusal(matrix, true) == "the record has no array 'frequency'");
  matrix.array<double>("frequency", "Hz", {1})[0] = 1.0;
  CHECK(refusal(matrix, true) == "the record lacks 'period', 'windows' or 'synchronous_windows'");
}
