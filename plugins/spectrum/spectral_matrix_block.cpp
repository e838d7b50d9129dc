#include "spectral_matrix_block.hpp"

#include <algorithm>
#include <cmath>

#include "averaging_dft_settings.hpp"
#include "records.hpp"
#include "response_record.hpp"

namespace bodeflow::spectrum {
namespace {

using Complex = std::complex<double>;

}  // namespace

void SpectralMatrixBlock::describe(Describe& d) {
  d.id("spectrum.spectral_matrix")
      .summary("Averages the matrix Z Z^H of the spectra of inputs and outputs over windows.")
      .cost_ns(10);
  d.doc(
      "Z(k) = 1/N sum_n z[n] exp(-2 pi i k n / N) of inputs, then outputs, in a window of one period. Windows may overlap by any "
      "shift: the "
      "phase of the shift cancels in Z Z^H. Whole periods give the mean and the noise covariance of one window beside it. The "
      "input of "
      "Frisch and total least squares identification.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, doi:10.1002/9781118287422");
  d.stream_in(input).doc("inputs of the plant: one channel each");
  d.stream_in(output).doc("outputs of the plant: one channel each");
  d.message_out(out).record_type("spectral_matrix").doc("at the end");
  d.required<std::int64_t>("period").range(3, 1e8).doc("samples in a window: one period of the excitation");
  d.optional<std::int64_t>("shift").range(1, 1e8).doc("samples from window to window; default: the period");
  d.parameter("skip", std::int64_t{0}).range(0, 1e9).doc("periods at the start that are left out: the transient");
  describe_lines(d);
}

void SpectralMatrixBlock::configure(const Parameters& p) {
  period_ = period_of(p);
  shift_ = p.has("shift") ? p.integer("shift") : period_;
  if (shift_ < 1) fail("shift " + std::to_string(shift_) + "; allowed: 1 and above");
  skip_ = p.integer("skip");
  choice_ = line_choice(p, period_);
}

void SpectralMatrixBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock) {
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock +
         "'; a spectrum needs one clock");
  }
  for (const StreamFacts* s : {&u, &y}) {
    if (s->length < 0 || s->length >= (skip_ + 1) * period_) continue;
    fail("the " + std::string(s == &u ? "input" : "output") + " has " + std::to_string(s->length) +
         " samples; needed: at least " + std::to_string((skip_ + 1) * period_) + " (" + std::to_string(skip_) +
         " skipped periods of " + std::to_string(period_) + " and one window)");
  }
  rate_ = u.rate;
  inputs_ = u.channels;
  const Signals inputs = signals_of(u, "input"), outputs = signals_of(y, "output");
  names_ = inputs.names;
  units_ = inputs.units;
  names_.insert(names_.end(), outputs.names.begin(), outputs.names.end());
  units_.insert(units_.end(), outputs.units.begin(), outputs.units.end());
}

void SpectralMatrixBlock::activate(const Activation& a) {
  const auto signals = static_cast<Eigen::Index>(names_.size());
  matrix_.emplace(period_, signals);
  periods_.emplace(period_, Layout{inputs_, signals - inputs_, 0}, AveragingDft::Detrend::none, a.vector_level);
  for (Windows* w : {&shifted_, &whole_}) w->frame.resize(period_, signals);
  reset();
}

void SpectralMatrixBlock::reset() {
  matrix_->clear();
  periods_->clear();
  for (Windows* w : {&shifted_, &whole_}) {
    w->waiting = skip_ * period_;
    w->filled = 0;
  }
  position_ = 0;
}

std::span<const double> SpectralMatrixBlock::samples(Io& io, Eigen::Index signal) const {
  return signal < inputs_ ? io.read(input, static_cast<int>(signal)) : io.read(output, static_cast<int>(signal - inputs_));
}

void SpectralMatrixBlock::check_finite(Io& io) const {
  for (Eigen::Index a = 0; a < shifted_.frame.cols(); ++a) {
    const auto x = samples(io, a);
    const auto bad = std::find_if(x.begin(), x.end(), [](double value) { return !std::isfinite(value); });
    if (bad == x.end()) continue;
    fail((a < inputs_ ? "input '" : "output '") + names_[static_cast<std::size_t>(a)] + "': sample " +
         std::to_string(position_ + (bad - x.begin())) + " is " + (std::isnan(*bad) ? "not a number" : "infinite"));
  }
}

/// Gives each window that this call completes to `take`, and keeps what it shares with the next one.
template <class Take>
void SpectralMatrixBlock::cut(Io& io, Windows& w, std::int64_t shift, Take take) {
  const auto all = static_cast<std::int64_t>(io.count());
  for (std::int64_t n = 0; n < all;) {
    const std::int64_t passed = std::min(w.waiting, all - n);
    w.waiting -= passed;
    n += passed;
    const std::int64_t count = std::min(all - n, period_ - w.filled);
    for (Eigen::Index a = 0; a < w.frame.cols(); ++a) {
      std::copy_n(samples(io, a).begin() + n, count, w.frame.col(a).begin() + w.filled);
    }
    w.filled += count;
    n += count;
    if (w.filled < period_) continue;
    take(w.frame);
    const std::int64_t kept = std::max<std::int64_t>(0, period_ - shift);
    for (Eigen::Index a = 0; a < w.frame.cols(); ++a) {
      std::copy_n(w.frame.col(a).begin() + (period_ - kept), kept, w.frame.col(a).begin());
    }
    w.filled = kept;
    w.waiting = std::max<std::int64_t>(0, shift - period_);
  }
}

void SpectralMatrixBlock::process(Io& io) {
  check_finite(io);
  // Windows that are whole periods apart have one phase: mean and covariance are theirs then, else of all whole periods.
  const bool synchronous = shift_ % period_ == 0;
  cut(io, shifted_, shift_, [&](const Eigen::MatrixXd& frame) {
    matrix_->add(frame);
    if (synchronous) periods_->add(frame);
  });
  if (!synchronous) cut(io, whole_, period_, [&](const Eigen::MatrixXd& frame) { periods_->add(frame); });
  position_ += static_cast<std::int64_t>(io.count());
}

std::vector<std::int64_t> SpectralMatrixBlock::lines() const {
  std::vector<std::int64_t> lines = choice_.candidates;
  if (lines.empty()) {
    for (std::int64_t k = 1; k <= (period_ - 1) / 2; ++k) lines.push_back(k);
  }
  if (choice_.threshold <= 0.0) return lines;
  const auto level = [&](std::int64_t k) { return std::sqrt(matrix_->matrix(k).topLeftCorner(inputs_, inputs_).trace().real()); };
  double largest = 0.0;
  for (const std::int64_t k : lines) largest = std::max(largest, level(k));
  lines.erase(
      std::remove_if(lines.begin(), lines.end(), [&](std::int64_t k) { return !(level(k) >= choice_.threshold * largest); }),
      lines.end());
  return lines;
}

RecordBuilder SpectralMatrixBlock::record() const {
  const std::vector<std::int64_t> chosen = lines();
  const auto count = static_cast<std::uint64_t>(chosen.size()), signals = static_cast<std::uint64_t>(names_.size());
  const auto s = static_cast<Eigen::Index>(signals);
  const std::string unit = common_unit(units_);
  const auto m = *periods_->moments();
  const auto windows = static_cast<double>(m.periods);
  RecordBuilder r("spectral_matrix");
  r.set("signal_names", names_);
  r.set("signal_units", units_);
  r.set("inputs", static_cast<std::int64_t>(inputs_));
  r.set("windows", matrix_->windows());
  r.set("synchronous_windows", m.periods);
  r.set("sample_rate", rate_.hz());
  r.set("period", period_);
  r.set("shift", shift_);
  fill_frequencies(r.array<double>("frequency", "Hz", {count}), chosen, rate_, period_);
  const auto numbers = r.array<std::int64_t>("line", "", {count});
  std::copy(chosen.begin(), chosen.end(), numbers.begin());
  const auto put = [&](const char* name, auto matrix_at) {
    const auto data = r.array<Complex>(name, squared_unit(unit), {count, signals, signals});
    std::size_t at = 0;
    for (const std::int64_t k : chosen) {
      const Eigen::MatrixXcd matrix = matrix_at(k);
      for (Eigen::Index a = 0; a < s; ++a) {
        for (Eigen::Index b = 0; b < s; ++b) data[at++] = matrix(a, b);
      }
    }
  };
  put("matrix", [&](std::int64_t k) { return matrix_->matrix(k); });
  if (m.has_noise()) put("noise_covariance", [&](std::int64_t k) { return Eigen::MatrixXcd(windows * covariance_at(m, k)); });
  const auto mean = r.array<Complex>("mean", unit, {count, signals});
  std::size_t at = 0;
  for (const std::int64_t k : chosen) {
    for (Eigen::Index a = 0; a < s; ++a) mean[at++] = m.mean(k, a);
  }
  return r;
}

void SpectralMatrixBlock::finish(Io& io) {
  if (matrix_->windows() == 0) {
    fail(std::to_string(position_) + " samples; needed: at least " + std::to_string((skip_ + 1) * period_) + " (" +
         std::to_string(skip_) + " skipped periods of " + std::to_string(period_) + " and one window)");
  }
  io.emit(out, record());
}

void SpectralMatrixBlock::deactivate() {
  matrix_.reset();
  periods_.reset();
}

}  // namespace bodeflow::spectrum
