#include "catch.hpp"
#include "periodic.hpp"
#include "plugins/block_driver.hpp"
#include "spectrum/spectral_matrix_block.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using spectrum::SpectralMatrix;
using spectrum::SpectralMatrixBlock;

namespace {

constexpr int kSamples = 64;
const std::vector<std::int64_t> kLines = lines_of(1, 21, 4);

StreamFacts facts(int channels, const char* unit, std::int64_t length = -1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate(640, 1);
  f.length = length;
  f.unit = unit;
  return f;
}

/// One input, two outputs, `count` samples of a periodic signal with noise.
std::vector<Channels> signals(std::size_t count, double deviation) {
  numerics::Random random(1);
  const Eigen::VectorXd u = random_multisine(kSamples, kLines, 1.0, random), y = filtered(u, resonance(10.0, 0.1));
  std::vector<Channels> s{Channels(1), Channels(2)};
  for (std::size_t n = 0; n < count; ++n) {
    const auto at = static_cast<Eigen::Index>(n % kSamples);
    s[0][0].push_back(u[at] + deviation * random.normal());
    s[1][0].push_back(y[at] + deviation * random.normal());
    s[1][1].push_back(-u[at] + deviation * random.normal());
  }
  return s;
}

struct Result {
  std::vector<std::uint8_t> bytes;
  std::int64_t windows, synchronous;
  std::vector<Complex> matrix, covariance, mean;
  std::vector<std::int64_t> lines;
};

Result run(const std::vector<Channels>& all, std::size_t chunk, std::int64_t shift, std::int64_t skip = 0) {
  BlockDriver<SpectralMatrixBlock> block;
  block.set("period", std::int64_t{kSamples}).set("shift", shift).set("skip", skip);
  block.configure();
  block.resolve({facts(1, "V"), facts(2, "V")});
  block.activate(chunk, Rate(640, 1));
  const std::size_t count = all[0][0].size();
  for (std::size_t n = 0; n < count; n += chunk) {
    std::vector<Channels> part = all;
    const auto from = static_cast<std::ptrdiff_t>(n), to = static_cast<std::ptrdiff_t>(std::min(n + chunk, count));
    for (auto& port : part) {
      for (auto& c : port) c = std::vector<double>(c.begin() + from, c.begin() + to);
    }
    block.process(part, static_cast<std::uint64_t>(to - from));
  }
  block.finish();
  REQUIRE(block.records().size() == 1);
  const RecordView r(block.records()[0]->bytes);
  Result x;
  x.bytes.assign(block.records()[0]->bytes, block.records()[0]->bytes + block.records()[0]->size);
  x.windows = *r.integer("windows");
  x.synchronous = *r.integer("synchronous_windows");
  const auto take = [&](const char* name) {
    const auto a = r.array(name);
    if (!a) return std::vector<Complex>();
    const auto values = a->as<Complex>();
    return std::vector<Complex>(values.begin(), values.end());
  };
  x.matrix = take("matrix");
  x.covariance = take("noise_covariance");
  x.mean = take("mean");
  const auto lines = r.array("line")->as<std::int64_t>();
  x.lines.assign(lines.begin(), lines.end());
  CHECK(r.texts("signal_names") == std::vector<std::string_view>{"input", "output_1", "output_2"});
  CHECK(r.array("matrix")->unit == "V^2");
  return x;
}

}  // namespace

TEST_CASE("spectral matrix: over whole periods it is the mean's product and the noise covariance") {
  const Result r = run(signals(20 * kSamples + 5, 0.1), 100, kSamples, 2);
  CHECK(r.windows == 18);
  CHECK(r.synchronous == 18);
  CHECK(r.lines == kLines);
  for (std::size_t k = 0; k < kLines.size(); ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const Complex expected = r.mean[3 * k + a] * std::conj(r.mean[3 * k + b]) + 17.0 / 18.0 * r.covariance[9 * k + 3 * a + b];
        CHECK(std::abs(r.matrix[9 * k + 3 * a + b] - expected) < 1e-13);
        CHECK(r.matrix[9 * k + 3 * a + b] == std::conj(r.matrix[9 * k + 3 * b + a]));
      }
    }
  }
}

TEST_CASE("spectral matrix: the shift of the windows cancels for a periodic signal") {
  const auto all = signals(12 * kSamples, 0.0);
  const Result whole = run(all, 64, kSamples);
  for (const std::int64_t shift : {1, 16, 37, 100, 128}) {
    const Result r = run(all, 50, shift);
    CHECK(r.windows == (11 * kSamples) / shift + 1);
    CHECK(r.synchronous == (shift == 128 ? 6 : 12));
    for (std::size_t i = 0; i < r.matrix.size(); ++i) CHECK(std::abs(r.matrix[i] - whole.matrix[i]) < 1e-13);
    for (std::size_t i = 0; i < r.mean.size(); ++i) CHECK(std::abs(r.mean[i] - whole.mean[i]) < 1e-13);
  }
}

TEST_CASE("spectral matrix: the noise covariance is that of one window, whatever the shift") {
  const double deviation = 0.2;
  for (const std::int64_t shift : {64, 16}) {
    const Result r = run(signals(400 * kSamples, deviation), 1000, shift);
    double sum = 0.0;
    for (std::size_t k = 0; k < r.lines.size(); ++k) {
      for (std::size_t a = 0; a < 3; ++a) sum += r.covariance[9 * k + 4 * a].real() / double(3 * r.lines.size());
    }
    CHECK(sum == Approx(deviation * deviation / kSamples).epsilon(0.05));
  }
}

TEST_CASE("spectral matrix: equal bit for bit whatever the size of the calls") {
  const auto all = signals(7 * kSamples + 3, 0.1);
  for (const std::int64_t shift : {16, 64, 100}) {
    const Result expected = run(all, 1, shift);
    for (const std::size_t chunk : {7u, 64u, 65u, 451u}) CHECK(run(all, chunk, shift).bytes == expected.bytes);
  }
}

TEST_CASE("spectral matrix: what can't be averaged is refused by name") {
  BlockDriver<SpectralMatrixBlock> block;
  block.set("period", std::int64_t{kSamples}).set("skip", std::int64_t{1});
  block.configure();
  CHECK(failure_of([&] {
          block.resolve({facts(1, "V", 127), facts(1, "V")});
        }) == "the input has 127 samples; needed: at least 128 (1 skipped periods of 64 and one window)");
  block.resolve({facts(1, "V"), facts(1, "V")});
  block.activate(100, Rate(640, 1));
  block.process({{std::vector<double>(100, 1.0)}, {std::vector<double>(100, 1.0)}}, 100);
  CHECK(failure_of([&] { block.finish(); }) == "100 samples; needed: at least 128 (1 skipped periods of 64 and one window)");
  std::vector<double> bad(10, 1.0);
  bad[3] = std::nan("");
  CHECK(failure_of([&] {
          block.process({{std::vector<double>(10, 1.0)}, {bad}}, 10);
        }) == "output 'output': sample 103 is not a number");
}
