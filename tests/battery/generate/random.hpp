#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace battery {

/// Random numbers that follow from a text: xoshiro256++ (D. Blackman, S. Vigna, 2019), begun with the text's SHA-256.
class Random {
 public:
  explicit Random(std::string_view seed);

  std::uint64_t bits();
  /// In [0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double log_uniform(double low, double high);
  /// Mean 0, variance 1 (polar method).
  double normal();
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }
  bool chance(double probability) { return uniform() < probability; }

  template <class T>
  void shuffle(std::vector<T>& list) {
    for (std::size_t n = list.size(); n > 1; --n) std::swap(list[n - 1], list[below(n)]);
  }

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace battery
