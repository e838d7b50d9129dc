#include "noise_block.hpp"

#include <algorithm>

#include "noise_record.hpp"

namespace bodeflow::frisch {

void Noise::describe(Describe& d) {
  d.id("frisch.noise").summary("Estimates the noise of voltage and current, or of any input and output, by the Frisch scheme.");
  d.doc(
      "The variances that leave the least sum of determinants while Phi - diag(input, output) stays positive semidefinite at all "
      "lines: the exact global minimum, then again without the lines that are nearest to singular. Beside them the scatter of "
      "whole periods pooled over the lines, which needs repeated periods, is unbiased and far less scattered. Every record is a "
      "band with noise of its own. All results are standard deviations of the samples.");
  d.reference(
      "P. Castaldi, M. Montanari, A. Tilli, Induction motor model identification via frequency-domain Frisch scheme, IFAC 2002");
  d.reference("S. Beghelli, P. Castaldi, U. Soverini, A frequential approach for errors-in-variables models, ECC 1997");
  d.message_in(matrix).record_type("spectral_matrix").doc("spectral matrices of one input and one output: one record a band");
  d.message_out(out).record_type("noise_variances").doc("first and second pass, and pooled");
  d.parameter("outliers", 0.08).unit("1").range(0.0, 0.9).doc("fraction of the lines that the second pass leaves out");
  d.parameter("outlier_measure", "determinant")
      .choices({"determinant", "relative"})
      .doc("what is near to singular: the determinant, or the determinant over the square of the trace");
}

void Noise::configure(const Parameters& p) {
  outliers_ = p.number("outliers");
  measure_ = p.text("outlier_measure") == "relative" ? OutlierMeasure::relative : OutlierMeasure::determinant;
}

void Noise::activate(const Activation&) { reset(); }

void Noise::receive(int, const RecordView& record, Io&) {
  auto band = band_of_matrix(record);
  if (!band) fail("matrix " + std::to_string(bands_.size() + 1) + ": " + band.error().text);
  bands_.push_back(std::move(*band));
}

void Noise::finish(Io& io) {
  if (bands_.empty()) fail("no record arrived at `matrix`");
  std::stable_sort(bands_.begin(), bands_.end(), [](const Band& a, const Band& b) { return a.mean.omega[0] < b.mean.omega[0]; });
  std::vector<FrischNoise> found;
  for (const Band& band : bands_) {
    const auto noise = frisch_noise(band.power, outliers_, measure_);
    if (!noise) fail("band of " + band.range() + ": " + noise.error().text);
    found.push_back(*noise);
  }
  io.emit(out, noise_record(bands_, found));
}

void Noise::reset() { bands_.clear(); }

}  // namespace bodeflow::frisch
