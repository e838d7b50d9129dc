#include "hand.hpp"

#include <array>
#include <cstring>

#include "measure.hpp"

namespace bench {
namespace {

constexpr std::size_t kChunk = 1024;

void keep(const void* data) { asm volatile("" : : "g"(data) : "memory"); }

template <int Blocks>
void multiply(std::size_t samples) {
  alignas(64) static std::array<double, kChunk> x, y;
  for (std::size_t n = 0; n < samples; n += kChunk) {
    std::memset(x.data(), 0, sizeof x);
    keep(x.data());
    for (std::size_t i = 0; i < kChunk; ++i) {
      double value = x[i];
      for (int b = 0; b < Blocks; ++b) value *= 1.0 + 1e-3 * (b + 1);
      y[i] = value;
    }
    keep(y.data());
  }
}

void copy(const double* x, double* y, std::size_t count) { std::memcpy(y, x, count * sizeof *x); }

}  // namespace

void hand_multiply(int blocks, std::size_t samples) {
  switch (blocks) {
    case 1:
      return multiply<1>(samples);
    case 4:
      return multiply<4>(samples);
    default:
      return multiply<16>(samples);
  }
}

void hand_feedback(std::size_t samples) {
  alignas(64) static std::array<double, kChunk> x, y;
  double last = 0.0;
  for (std::size_t n = 0; n < samples; n += kChunk) {
    std::memset(x.data(), 0, sizeof x);
    keep(x.data());
    for (std::size_t i = 0; i < kChunk; ++i) y[i] = last = 0.5 * (x[i] + 0.8 * last);
    keep(y.data());
  }
}

std::vector<double> hand_latency(std::size_t samples) {
  using Block = void (*)(const double*, double*, std::size_t);
  std::array<Block, 8> chain{};
  chain.fill(copy);
  std::size_t count = 1;
  asm volatile("" : "+m"(chain), "+r"(count));  // which function, and how many samples, is known only when it runs
  std::array<double, 9> signal{};
  std::vector<double> ages;
  ages.reserve(samples);
  for (std::size_t n = 0; n < samples; ++n) {
    signal[0] = now_ns();
    for (std::size_t b = 0; b < chain.size(); ++b) chain[b](&signal[b], &signal[b + 1], count);
    ages.push_back(now_ns() - signal[8]);
  }
  return ages;
}

}  // namespace bench
