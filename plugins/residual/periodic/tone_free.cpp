#include "periodic/tone_free.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "periodic/leakage.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// What a tone of so many times the median power around it leaks is lost in the noise a few bins on.
constexpr double kHigh = 50.0;
constexpr int kMostTones = 200;
// Bins between the lines that tell how high one stands.
constexpr std::size_t kAround = 60;
// Bins to either side that tell the frequency and the amplitude of a tone.
constexpr Eigen::Index kBeside = 12;
constexpr int kGrid = 20, kThirds = 40;

class ToneFree {
 public:
  ToneFree(const Eigen::VectorXcd& bins, Eigen::Index periods, Eigen::Index samples)
      : left_(bins), periods_(periods), samples_(static_cast<double>(samples)) {
    for (Eigen::Index l = 0; l < bins.size(); ++l)
      if (is_between(l)) between_.push_back(l);
  }

  void take_out_all() {
    for (int n = 0; n < kMostTones; ++n) {
      const Eigen::Index highest = highest_bin();
      if (highest == 0) return;
      take_out(highest);
    }
  }

  Eigen::VectorXd power() const {
    Eigen::VectorXd p(static_cast<Eigen::Index>(between_.size()));
    for (std::size_t n = 0; n < between_.size(); ++n) p[static_cast<Eigen::Index>(n)] = std::norm(left_[between_[n]]);
    return p;
  }

 private:
  bool is_between(Eigen::Index l) const { return l % periods_ != 0; }

  /// The bin that stands highest above the median of its part of the band; 0 where none is high.
  Eigen::Index highest_bin() const {
    double most = kHigh;
    Eigen::Index where = 0;
    for (std::size_t begin = 0; begin < between_.size(); begin += kAround) {
      const std::size_t end = std::min(begin + kAround, between_.size());
      std::vector<double> part;
      for (std::size_t n = begin; n < end; ++n) part.push_back(std::norm(left_[between_[n]]));
      const std::size_t at = static_cast<std::size_t>(std::max_element(part.begin(), part.end()) - part.begin());
      const double highest = part[at];
      const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
      std::nth_element(part.begin(), middle, part.end());
      if (!(highest > most * *middle)) continue;
      most = highest / *middle;
      where = between_[begin + at];
    }
    return where;
  }

  /// Amplitude of exp(j 2 pi f t) at `f` bins that fits best to the bins beside bin `l`, and the power that it explains there.
  std::pair<Complex, double> fitted(double f, Eigen::Index l) const {
    Complex product = 0.0;
    double square = 0.0;
    for (Eigen::Index b = std::max<Eigen::Index>(l - kBeside, 1); b <= std::min(l + kBeside, left_.size() - 1); ++b) {
      if (!is_between(b)) continue;
      const Complex shape = leaked((f - static_cast<double>(b)) / samples_, samples_);
      product += std::conj(shape) * left_[b];
      square += std::norm(shape);
    }
    return {product / square, std::norm(product) / square};
  }

  void take_out(Eigen::Index l) {
    double best = static_cast<double>(l), explained = 0.0;
    for (int n = -kGrid; n <= kGrid; ++n) {
      const double f = static_cast<double>(l) + static_cast<double>(n) / kGrid;
      const double there = fitted(f, l).second;
      if (there > explained) explained = there, best = f;
    }
    double low = best - 1.0 / kGrid, high = best + 1.0 / kGrid;
    for (int n = 0; n < kThirds; ++n) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      if (fitted(a, l).second < fitted(b, l).second) {
        low = a;
      } else {
        high = b;
      }
    }
    const double f = 0.5 * (low + high);
    const Complex amplitude = fitted(f, l).first;
    for (const Eigen::Index b : between_) {
      const double at = static_cast<double>(b);
      left_[b] -=
          amplitude * leaked((f - at) / samples_, samples_) + std::conj(amplitude) * leaked((-f - at) / samples_, samples_);
    }
  }

  Eigen::VectorXcd left_;
  Eigen::Index periods_;
  double samples_;
  std::vector<Eigen::Index> between_;
};

}  // namespace

Eigen::VectorXd tone_free_power(const Eigen::VectorXcd& bins, Eigen::Index periods, Eigen::Index samples) {
  ToneFree tones(bins, periods, samples);
  tones.take_out_all();
  return tones.power();
}

}  // namespace bodeflow::residual
