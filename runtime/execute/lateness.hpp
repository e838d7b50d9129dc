#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bodeflow::execute {

/// How late the chunks of a paced run began, against their absolute times. Everything is zero, and `bins` empty, where none was.
struct Lateness {
  static constexpr std::size_t kBins = 22;

  std::uint64_t chunks = 0;
  double min_s = 0.0, max_s = 0.0;
  double median_s = 0.0, p99_s = 0.0;  ///< to 1/16 of their power of two
  /// Chunks by lateness: below 1 us, then from 2^(k-1) to 2^k us for k = 1 to 20, then the rest.
  std::vector<std::uint64_t> bins;
};

/// Counts latenesses; each octave from 1 us to 1 s has sixteen bins. Adding neither allocates nor locks; one thread adds at a
/// time, any thread may read meanwhile (what is being added then counts or does not).
class LatenessCounter {
 public:
  void add(std::int64_t nanoseconds);
  void add(const LatenessCounter& other);
  Lateness summary() const;

 private:
  static constexpr std::size_t kParts = 16;                                  ///< of an octave, and of the first microsecond
  static constexpr std::size_t kCells = (Lateness::kBins - 1) * kParts + 1;  ///< the last one holds the rest

  std::array<std::atomic<std::uint64_t>, kCells> cells_{};
  std::atomic<std::uint64_t> chunks_{0};
  std::atomic<std::int64_t> min_{0}, max_{0};
};

}  // namespace bodeflow::execute
