#include <cmath>
#include <vector>

#include "bodeflow/numerics/fft.hpp"
#include "catch.hpp"
#include "plugins/loaded_block.hpp"
#include "shift_register.hpp"

using namespace bodeflow::generators;
using bodeflow::test::LoadedBlock;

namespace {

// Polynomials over GF(2) as bits, degree up to 32.
std::uint64_t product(std::uint64_t a, std::uint64_t b, std::uint64_t modulus, int degree) {
  std::uint64_t result = 0;
  for (; b != 0; b >>= 1) {
    if ((b & 1) != 0) result ^= a;
    a <<= 1;
    if ((a >> degree & 1) != 0) a ^= modulus;
  }
  return result;
}

std::uint64_t power_of_x(std::uint64_t exponent, std::uint64_t modulus, int degree) {
  std::uint64_t result = 1, factor = 2;
  if (degree == 1) factor ^= modulus;
  for (; exponent != 0; exponent >>= 1) {
    if ((exponent & 1) != 0) result = product(result, factor, modulus, degree);
    factor = product(factor, factor, modulus, degree);
  }
  return result;
}

std::vector<std::uint64_t> prime_factors(std::uint64_t n) {
  std::vector<std::uint64_t> factors;
  for (std::uint64_t p = 2; p * p <= n; ++p) {
    if (n % p != 0) continue;
    factors.push_back(p);
    while (n % p == 0) n /= p;
  }
  if (n > 1) factors.push_back(n);
  return factors;
}

}  // namespace

TEST_CASE("the feedback polynomial of every length from 2 to 32 bits is primitive") {
  for (int bits = kLeastBits; bits <= kMostBits; ++bits) {
    // x[n] = xor x[n - t]: the polynomial is x^bits + sum x^(bits - t).
    std::uint64_t polynomial = std::uint64_t{1} << bits;
    for (const int stage : feedback_stages(bits)) polynomial |= std::uint64_t{1} << (bits - stage);
    const std::uint64_t order = (std::uint64_t{1} << bits) - 1;
    CAPTURE(bits);
    CHECK(power_of_x(order, polynomial, bits) == 1);
    for (const std::uint64_t p : prime_factors(order)) CHECK(power_of_x(order / p, polynomial, bits) != 1);
  }
}

TEST_CASE("a shift register gives the recurrence of its feedback stages") {
  for (int bits = kLeastBits; bits <= kMostBits; ++bits) {
    ShiftRegister source(bits);
    std::vector<int> x;
    for (int n = 0; n < 200; ++n) x.push_back(source.next() ? 1 : 0);
    for (std::size_t n = static_cast<std::size_t>(bits); n < x.size(); ++n) {
      int sum = 0;
      for (const int stage : feedback_stages(bits)) sum ^= x[n - static_cast<std::size_t>(stage)];
      REQUIRE(x[n] == sum);
    }
  }
}

TEST_CASE("a binary sequence has the period 2^n - 1 and a two-valued autocorrelation, exactly") {
  for (const std::int64_t bits : {2, 3, 5, 8, 10}) {
    const auto size = static_cast<std::size_t>((1 << bits) - 1);
    LoadedBlock block("generators.prbs");
    block.set("sample_rate", 1e3).set("bits", bits).start();
    const auto y = block.run(2 * size, 61)[0];
    for (std::size_t n = 0; n < size; ++n) REQUIRE(y[n + size] == y[n]);
    for (std::size_t shift = 0; shift < size; ++shift) {
      double sum = 0;
      for (std::size_t n = 0; n < size; ++n) sum += y[n] * y[n + shift];
      REQUIRE(sum == (shift == 0 ? static_cast<double>(size) : -1.0));
    }
  }
}

TEST_CASE("an inverse-repeat sequence has no even line, and twice the period") {
  LoadedBlock block("generators.prbs");
  block.set("sample_rate", 1e3).set("bits", std::int64_t{7}).set("inverse_repeat", true).start();
  const auto y = block.run(508, 61)[0];
  for (std::size_t n = 0; n < 254; ++n) REQUIRE(y[n + 254] == y[n]);
  for (std::size_t n = 0; n < 127; ++n) REQUIRE(y[n + 127] == -y[n]);
  const Eigen::VectorXd spectrum = bodeflow::numerics::half_dft(Eigen::Map<const Eigen::VectorXd>(y.data(), 254)).cwiseAbs();
  for (Eigen::Index k = 0; k < 127; k += 2) CHECK(spectrum[k] < 1e-12);
  for (Eigen::Index k = 1; k < 127; k += 2) CHECK(spectrum[k] == Approx(2 * std::sqrt(128.0)));
}

TEST_CASE("each bit is held, levels are live, and the stream ends after its periods") {
  LoadedBlock block("generators.prbs"), held("generators.prbs");
  block.set("sample_rate", 1e3).set("bits", std::int64_t{4}).start();
  held.set("sample_rate", 1e3).set("bits", std::int64_t{4}).set("hold", std::int64_t{3}).set("periods", std::int64_t{2});
  held.set("amplitude", 2.0).set("offset", 5.0).start();
  CHECK(held.resolve()[0].length == 90);
  const auto bits = block.run(30)[0];
  const auto y = held.run(60, 7)[0];
  for (std::size_t n = 0; n < 60; ++n) REQUIRE(y[n] == 5 + 2 * bits[n / 3]);
  held.change("amplitude", 1.0);
  const auto rest = held.run(1000, 7)[0];
  REQUIRE(rest.size() == 30);
  for (std::size_t n = 0; n < 30; ++n) CHECK(rest[n] == 5 + bits[(60 + n) / 3 % 15]);
}

TEST_CASE("a binary sequence tells its lines") {
  LoadedBlock block("generators.prbs");
  block.set("sample_rate", 310.0).set("bits", std::int64_t{5}).configure();
  const auto notes = block.resolve()[0].notes;
  CHECK(notes.at("excitation.period") == std::vector<double>{0.1});
  REQUIRE(notes.at("excitation.frequencies").size() == 15);
  for (const double amplitude : notes.at("excitation.amplitudes")) CHECK(amplitude == Approx(2 * std::sqrt(32.0) / 31));
}

TEST_CASE("prbs: with first_bit the sequence begins as many bits later") {
  LoadedBlock whole("generators.prbs"), later("generators.prbs");
  for (LoadedBlock* block : {&whole, &later})
    block->set("sample_rate", 100.0).set("bits", std::int64_t{5}).set("hold", std::int64_t{3});
  later.set("first_bit", std::int64_t{4});
  const auto all = whole.start().run(93)[0], rest = later.start().run(60)[0];
  CHECK(std::vector<double>(all.begin() + 12, all.begin() + 72) == rest);
}
