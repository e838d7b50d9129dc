#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Sums over the newest window of a stream times a sine, without drift.
namespace bodeflow::spectrum {

/// 2/N exp(-2 pi i m n / N), n = 0 .. N-1: m whole cycles in a window of N samples. Each value is rounded once: the angle is
/// reduced in whole numbers. Repeats after N samples, so that sample n of a stream takes entry n mod N, however long the stream.
class SineTable {
 public:
  /// window: N >= 3; cycles: 1 <= m < N / 2.
  SineTable(std::int64_t window, std::int64_t cycles);

  std::complex<double> operator[](std::size_t n) const { return values_[n]; }
  std::size_t size() const { return values_.size(); }

 private:
  std::vector<std::complex<double>> values_;
};

/// The sum of the newest L terms of a sequence, by adding the newest and taking away the one that leaves.
///
/// Beside this running sum a fresh one is kept, of the terms since the last multiple of L; at the next multiple, when it spans
/// the window, it takes the running sum's place. So what the object holds at a multiple of L is a function of the newest L terms
/// alone: rounding errors are those of at most 2 L additions, whatever came before, after 1e9 terms as after the first.
/// Cost: 3 additions a term; memory: L terms. The terms before the first are zero.
class SineWindow {
 public:
  /// length: L >= 1.
  explicit SineWindow(std::int64_t length) : terms_(static_cast<std::size_t>(length)) {}

  /// The sum after one more term.
  std::complex<double> push(std::complex<double> term) {
    running_ += term - terms_[at_];
    fresh_ += term;
    terms_[at_] = term;
    if (++at_ == terms_.size()) {
      at_ = 0;
      running_ = fresh_;
      fresh_ = 0.0;
    }
    return running_;
  }

  /// Back to zeros.
  void clear();

 private:
  std::vector<std::complex<double>> terms_;
  std::size_t at_ = 0;
  std::complex<double> running_ = 0.0;
  std::complex<double> fresh_ = 0.0;
};

}  // namespace bodeflow::spectrum
