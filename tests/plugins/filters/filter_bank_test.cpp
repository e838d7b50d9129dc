#include "filter_bank.hpp"

#include <bodeflow/numerics/iir_design.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <limits>

#include "catch.hpp"
#include "fir_filter.hpp"

using bodeflow::filters::BankFilter;
using bodeflow::filters::FilterBank;
using bodeflow::filters::FirFilter;
namespace numerics = bodeflow::numerics;

namespace {

using Channels = std::vector<std::vector<double>>;

// Those that this processor has.
std::vector<int> vector_levels() {
  std::vector<int> levels{1};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) levels.push_back(3);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    levels.push_back(4);
  }
#endif
  return levels;
}

Channels noise(std::size_t channels, std::size_t count) {
  numerics::Random random(7);
  Channels x(channels, std::vector<double>(count));
  for (auto& channel : x) {
    for (double& value : channel) value = random.normal();
  }
  return x;
}

std::vector<BankFilter> butterworth_bank(std::size_t count) {
  std::vector<BankFilter> filters;
  for (std::size_t k = 0; k < count; ++k) {
    const double low = 0.05 + 0.1 * static_cast<double>(k);
    const int order = 1 + static_cast<int>(k % 3);  // sections that others lack
    filters.push_back(
        {"", numerics::design_iir({numerics::FilterKind::butterworth, numerics::Pass::band, order, {low, low + 0.2}})->sections});
  }
  return filters;
}

std::vector<BankFilter> narrow_bank(std::size_t count) {
  std::vector<BankFilter> filters;
  for (std::size_t k = 0; k < count; ++k) {
    const int m = 1 + static_cast<int>(k % 3);
    filters.push_back({"", *numerics::NarrowBandPass::design(0.9, m, 0.035, 0.1 + 0.1 * static_cast<double>(k))});
  }
  return filters;
}

Channels run(FilterBank& bank, const Channels& x, const std::vector<std::size_t>& chunks, int level) {
  const std::size_t count = x[0].size();
  Channels y(bank.outputs(), std::vector<double>(count));
  std::size_t done = 0;
  for (std::size_t i = 0; done < count; ++i) {
    const std::size_t part = std::min(chunks[i % chunks.size()], count - done);
    std::vector<const double*> from;
    std::vector<double*> to;
    for (const auto& channel : x) from.push_back(channel.data() + done);
    for (auto& channel : y) to.push_back(channel.data() + done);
    CHECK_FALSE(bank.run(from.data(), to.data(), part, level));
    done += part;
  }
  return y;
}

// The same by one filter after the other, sample by sample.
Channels one_by_one(const std::vector<BankFilter>& filters, const Channels& x) {
  Channels y;
  for (const auto& channel : x) {
    for (const BankFilter& f : filters) {
      auto& out = y.emplace_back();
      if (const auto* sections = std::get_if<numerics::Sections>(&f.filter)) {
        numerics::SectionFilter filter(*sections);
        for (const double value : channel) out.push_back(filter.step(value));
      } else {
        auto filter = std::get<numerics::NarrowBandPass>(f.filter);
        for (const double value : channel) out.push_back(filter.step(value));
      }
    }
  }
  return y;
}

}  // namespace

TEST_CASE("a bank has the bits of its filters one by one, at every vector level, for any chunks and numbers of outputs") {
  for (const bool narrow : {false, true}) {
    for (const auto& [filters, channels] : {std::pair{1, 1}, {1, 3}, {1, 8}, {5, 1}, {8, 2}, {3, 7}, {16, 1}, {9, 2}}) {
      const auto bank =
          narrow ? narrow_bank(static_cast<std::size_t>(filters)) : butterworth_bank(static_cast<std::size_t>(filters));
      const Channels x = noise(static_cast<std::size_t>(channels), 300);
      const Channels expected = one_by_one(bank, x);
      for (const int level : vector_levels()) {
        for (const std::vector<std::size_t>& chunks : {std::vector<std::size_t>{300}, {1}, {7, 64, 1, 50}}) {
          FilterBank fresh(bank, x.size());
          INFO((narrow ? "narrow " : "direct ") << filters << " filters, " << channels << " channels, level " << level);
          CHECK(run(fresh, x, chunks, level) == expected);
        }
      }
    }
  }
}

TEST_CASE("reset takes a bank back to a past of zeros") {
  FilterBank bank(butterworth_bank(3), 2);
  const Channels x = noise(2, 100);
  const Channels first = run(bank, x, {100}, 1);
  bank.reset();
  CHECK(run(bank, x, {9}, 1) == first);
}

TEST_CASE("the output of a bank after a signal ends in exact zeros, not in denormal numbers") {
  for (const int level : vector_levels()) {
    FilterBank bank(narrow_bank(9), 1);
    Channels x = noise(1, 12000);
    std::fill(x[0].begin() + 100, x[0].end(), 0.0);
    const Channels y = run(bank, x, {500}, level);
    for (const auto& channel : y) {
      CHECK(channel[150] != 0);
      CHECK(channel[11999] == 0);
      for (const double value : channel) CHECK((value == 0 || std::abs(value) > 1e-300));
    }
  }
}

TEST_CASE("a bank names the channel that brought a value that is not finite") {
  for (const int level : vector_levels()) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      FilterBank bank(butterworth_bank(3), 5);
      Channels x = noise(5, 64);
      x[3][10] = bad;
      Channels y(15, std::vector<double>(64));
      std::vector<const double*> from;
      std::vector<double*> to;
      for (const auto& channel : x) from.push_back(channel.data());
      for (auto& channel : y) to.push_back(channel.data());
      CHECK(bank.run(from.data(), to.data(), 64, level) == std::size_t{3});
    }
  }
}

TEST_CASE("a finite impulse response has the bits of its sum in rising order, at every vector level and for any chunks") {
  const std::vector<double> x = noise(1, 500)[0];
  for (const std::size_t taps : {1u, 2u, 9u, 64u, 65u, 200u}) {
    const std::vector<double> h = noise(1, taps)[0];
    std::vector<double> expected(x.size());
    for (std::size_t n = 0; n < x.size(); ++n) {
      for (std::size_t j = 0; j < taps; ++j) expected[n] += h[j] * (n >= j ? x[n - j] : 0.0);
    }
    for (const int level : vector_levels()) {
      for (const std::size_t chunk : {500u, 1u, 33u}) {
        FirFilter filter(h, chunk);
        std::vector<double> y = x;  // in place
        for (std::size_t n = 0; n < y.size(); n += chunk) {
          const std::span<double> part(y.data() + n, std::min(chunk, y.size() - n));
          filter.run(part, part, level);
        }
        CHECK(y == expected);
      }
    }
  }
}
