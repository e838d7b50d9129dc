#include "hand.hpp"

#include <cmath>
#include <cstring>

namespace bench {
namespace {

constexpr std::size_t kChunk = 1024;

void keep(const void* data) { asm volatile("" : : "g"(data) : "memory"); }

/// Coefficients and states, a lane a biquad.
struct Lanes {
  alignas(64) double b0[kBiquads], b1[kBiquads], b2[kBiquads], a1[kBiquads], a2[kBiquads], s1[kBiquads], s2[kBiquads];

  Lanes() {
    const auto c = biquad_coefficients();
    for (std::size_t i = 0; i < kBiquads; ++i) {
      b0[i] = c[i][0];
      b1[i] = c[i][1];
      b2[i] = c[i][2];
      a1[i] = c[i][3];
      a2[i] = c[i][4];
      s1[i] = s2[i] = 0;
    }
  }

  /// y = the 16 outputs for x.
  [[gnu::always_inline]] void step(double x, double* y) {
    for (std::size_t i = 0; i < kBiquads; ++i) {
      y[i] = b0[i] * x + s1[i];
      s1[i] = (b1[i] * x + s2[i]) - a1[i] * y[i];
      s2[i] = b2[i] * x - a2[i] * y[i];
    }
  }
};

}  // namespace

std::array<std::array<double, 5>, kBiquads> biquad_coefficients() {
  std::array<std::array<double, 5>, kBiquads> c{};
  for (std::size_t i = 0; i < kBiquads; ++i) {
    const double r = 0.98, w = 3.14159 * (0.05 + 0.85 * static_cast<double>(i) / (kBiquads - 1));
    c[i] = {1 - r, 0.0, r - 1, -2 * r * std::cos(w), r * r};
  }
  return c;
}

std::array<double, kTaps> fir_coefficients() {
  std::array<double, kTaps> h{};
  for (std::size_t j = 0; j < kTaps; ++j) {
    const double t = static_cast<double>(j) - 0.5 * (kTaps - 1);
    h[j] = std::sin(0.9 * t) / (3.14159 * t) * (0.54 + 0.46 * std::cos(3.14159 * t / 32));
  }
  return h;
}

void hand_fir(std::size_t samples) {
  constexpr std::size_t kBlock = 32;
  const auto h = fir_coefficients();
  alignas(64) static double x[kChunk + kTaps - 1], y[kChunk];
  double* const now = x + kTaps - 1;
  for (std::size_t done = 0; done < samples; done += kChunk) {
    std::memset(now, 0, kChunk * sizeof(double));
    keep(x);
    for (std::size_t n = 0; n < kChunk; n += kBlock) {
      double sum[kBlock] = {};
      for (std::size_t j = 0; j < kTaps; ++j) {
        for (std::size_t i = 0; i < kBlock; ++i) sum[i] += h[j] * *(now + n + i - j);
      }
      std::memcpy(y + n, sum, sizeof sum);
    }
    std::memmove(x, x + kChunk, (kTaps - 1) * sizeof(double));
    keep(y);
  }
}

void hand_biquads_frames(std::size_t samples) {
  alignas(64) static double x[kChunk], y[kChunk][kBiquads];
  Lanes lanes;
  for (std::size_t done = 0; done < samples; done += kChunk) {
    std::memset(x, 0, sizeof x);
    keep(x);
    Lanes now = lanes;
    for (std::size_t n = 0; n < kChunk; ++n) now.step(x[n], y[n]);
    lanes = now;
    keep(y);
  }
}

void hand_biquads_channels(std::size_t samples) {
  constexpr std::size_t kPart = 64;  // frames that stay in the cache until they are dealt out
  alignas(64) static double x[kChunk], frames[kPart][kBiquads], y[kBiquads][kChunk];
  Lanes lanes;
  for (std::size_t done = 0; done < samples; done += kChunk) {
    std::memset(x, 0, sizeof x);
    keep(x);
    Lanes now = lanes;
    for (std::size_t first = 0; first < kChunk; first += kPart) {
      for (std::size_t n = 0; n < kPart; ++n) now.step(x[first + n], frames[n]);
      for (std::size_t i = 0; i < kBiquads; ++i) {
        for (std::size_t n = 0; n < kPart; ++n) y[i][first + n] = frames[n][i];
      }
    }
    lanes = now;
    keep(y);
  }
}

}  // namespace bench
