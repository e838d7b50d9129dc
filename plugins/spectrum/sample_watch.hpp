#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

namespace bodeflow::spectrum {

/// Looks at the samples of one channel as they pass: are they finite, do they change, are they clipped?
class SampleWatch {
 public:
  /// Takes the next samples. Returns the number of those before the first that is not finite: all of them, if none is.
  std::size_t add(std::span<const double> samples);

  /// Samples taken.
  std::int64_t count() const { return count_; }
  /// The largest magnitude of them; 0 for none.
  double amplitude() const { return std::max(std::abs(greatest_.value), std::abs(least_.value)); }
  /// True while all samples were equal.
  bool constant() const { return count_ == 0 || greatest_.value == least_.value; }
  /// A sentence with what to do when the channel looks clipped, else "". It does when it comes to its greatest or least value at
  /// least three times and has it more than four times as often as the value next to it: neither a quantised sine, a held or
  /// periodic signal, nor a binary one does. `name`: for the sentence, as in "input 'u'".
  std::string clipping(const std::string& name) const;

 private:
  struct Extreme {
    double value = 0.0;
    std::int64_t samples = 0;  ///< that have the value
    std::int64_t visits = 0;   ///< runs of such samples
    double next = 0.0;         ///< the value next to it
    std::int64_t next_samples = 0;
  };
  /// side: 1 for the greatest value, -1 for the least.
  void note(Extreme& extreme, double x, double side) const;

  std::int64_t count_ = 0;
  double last_ = 0.0;
  Extreme greatest_, least_;
};

}  // namespace bodeflow::spectrum
