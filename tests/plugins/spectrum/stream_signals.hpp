#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/random.hpp>
#include <string>
#include <vector>

#include "plugins/block_driver.hpp"

namespace bodeflow::test {

/// Facts of a stream at 1 kHz.
inline StreamFacts stream(std::vector<std::string> names, const char* unit, std::int64_t length = -1) {
  StreamFacts f;
  f.known = true;
  f.channels = static_cast<int>(names.size());
  f.rate = Rate(1000, 1);
  f.length = length;
  f.unit = unit;
  f.channel_names = std::move(names);
  return f;
}

/// White normal samples.
inline std::vector<double> white_samples(std::size_t count, std::uint64_t seed, double std = 1.0) {
  numerics::Random random(seed);
  std::vector<double> x(count);
  for (double& v : x) v = std * random.normal();
  return x;
}

/// y[n] = pole y[n-1] + (1 - pole) u[n-1].
inline std::vector<double> lagged(const std::vector<double>& u, double pole) {
  std::vector<double> y(u.size());
  for (std::size_t n = 1; n < u.size(); ++n) y[n] = pole * y[n - 1] + (1.0 - pole) * u[n - 1];
  return y;
}

/// Feeds ports of samples to a block, `chunk` at a time.
template <class Driver>
void feed(Driver& block, const std::vector<Channels>& ports, std::size_t chunk) {
  const std::size_t total = ports.front().front().size();
  for (std::size_t n = 0; n < total; n += chunk) {
    const std::size_t count = std::min(chunk, total - n);
    std::vector<Channels> part = ports;
    for (auto& port : part) {
      for (auto& c : port) c = {c.begin() + static_cast<std::ptrdiff_t>(n), c.begin() + static_cast<std::ptrdiff_t>(n + count)};
    }
    block.process(part, count);
  }
}

}  // namespace bodeflow::test
