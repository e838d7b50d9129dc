#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "bench_data.hpp"
#include "catch.hpp"
#include "system/command.hpp"

using namespace bodeflow::test;
using Words = std::vector<std::string>;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kPeriod = 512;       // samples, at 100 Hz
constexpr int kStepsASample = 16;  // of the integration

/// What a file of a mass on a spring holds: 0.2 kg, 0.8 N s/m, 60 N/m, and a spring that stiffens with the cube.
struct Oscillator {
  double amplitude = 1.0;  ///< of each line [N]
  double cubic = 0.0;      ///< [N/m^3]
  unsigned seed = 1;       ///< of phases and noise
  int periods = 6;
  double noise = 1e-4;  ///< standard deviation [m]
};

/// Odd lines 1, 3 ... 99 of the period, every fourth left out, with random phases.
class Force {
 public:
  explicit Force(const Oscillator& o) : amplitude_(o.amplitude), random_(o.seed) {
    std::uniform_real_distribution<double> phase(0.0, 2.0 * kPi);
    for (int k = 1; k < 100; k += 2) {
      if (k % 8 == 5) continue;
      lines_.push_back(k);
      phases_.push_back(phase(random_));
    }
  }
  double at(double sample) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < lines_.size(); ++i) sum += std::cos(2.0 * kPi * lines_[i] * sample / kPeriod + phases_[i]);
    return amplitude_ * sum;
  }

 private:
  double amplitude_;
  std::mt19937 random_;
  std::vector<double> lines_, phases_;
};

/// Columns t [s], force [N], position [m]: one period of transient and `periods` more, the plant integrated by Runge and Kutta.
std::string oscillator_csv(const Oscillator& o) {
  const Force force(o);
  const double step = 0.01 / kStepsASample;
  std::vector<double> halves(static_cast<std::size_t>(2 * kStepsASample * kPeriod));
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = force.at(static_cast<double>(i) / (2 * kStepsASample));
  std::mt19937 random(o.seed + 1000);
  std::normal_distribution<double> noise(0.0, o.noise);
  std::vector<double> t, u, y;
  double x = 0.0, v = 0.0;
  const auto acceleration = [&](double position, double velocity, double f) {
    return (f - 0.8 * velocity - 60.0 * position - o.cubic * position * position * position) / 0.2;
  };
  for (int n = 0; n < (o.periods + 1) * kPeriod; ++n) {
    t.push_back(0.01 * n);
    u.push_back(halves[static_cast<std::size_t>(2 * kStepsASample * (n % kPeriod))]);
    y.push_back(x + noise(random));
    for (int k = 0; k < kStepsASample; ++k) {
      const auto i = static_cast<std::size_t>(2 * (kStepsASample * (n % kPeriod) + k));
      const double f0 = halves[i], f1 = halves[i + 1], f2 = halves[(i + 2) % halves.size()];
      const double k1x = v, k1v = acceleration(x, v, f0);
      const double k2x = v + 0.5 * step * k1v, k2v = acceleration(x + 0.5 * step * k1x, k2x, f1);
      const double k3x = v + 0.5 * step * k2v, k3v = acceleration(x + 0.5 * step * k2x, k3x, f1);
      const double k4x = v + step * k3v, k4v = acceleration(x + step * k3x, k4x, f2);
      x += step / 6.0 * (k1x + 2.0 * k2x + 2.0 * k3x + k4x);
      v += step / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
    }
  }
  return csv_of({"t [s]", "force [N]", "position [m]"}, {t, u, y});
}

/// Four files of one plant: two levels to fit, one to select, one to test.
void write_experiment(const Folder& folder, double cubic) {
  folder.write("low.csv", oscillator_csv({0.15, cubic, 1}));
  folder.write("high.csv", oscillator_csv({0.4, cubic, 2}));
  folder.write("select.csv", oscillator_csv({0.3, cubic, 3}));
  folder.write("test.csv", oscillator_csv({0.35, cubic, 4}));
}

const Words kColumns{"--input", "force", "--output", "position"};
const Words kPeriodic{"--period", "512", "--skip", "1"};

Words words(Words a, const Words& b, const Words& c = {}, const Words& d = {}) {
  for (const Words* more : {&b, &c, &d}) a.insert(a.end(), more->begin(), more->end());
  return a;
}

nlohmann::json trace_in(const Folder& folder) {
  return nlohmann::json::parse(folder.read("out/result.json"))["results"]["trace"]["attributes"];
}

bool holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return true;
  UNSCOPED_INFO("'" << part << "' is not in:\n" << text);
  return false;
}

std::string refusal(const Folder& folder, const Words& arguments, int code) {
  const auto ended = run_bodeflow(arguments, folder.path());
  INFO(ended.err);
  CHECK(ended.exit_code == code);
  CHECK(ended.out.empty());
  return ended.err;
}

}  // namespace

TEST_CASE("trace names a spring that stiffens, from four files, and tells the error before and after") {
  const Folder folder;
  write_experiment(folder, 4e4);
  const auto ended = run_bodeflow(
      words({"trace", "--model", "second_order", "--fit", "low.csv", "high.csv", "--select", "select.csv", "--test", "test.csv",
             "--effects", "delay,offset", "--effects", "cubic_stiffness,coulomb_friction", "--out", "out"},
            kColumns, kPeriodic),
      folder.path());
  INFO(ended.err << ended.out);
  REQUIRE(ended.exit_code == 0);
  const auto found = trace_in(folder);
  CHECK(found["verdict"] == "named");
  CHECK(found["effects"] == nlohmann::json{"cubic_stiffness"});
  const double before = found["error_before"], after = found["error_after"], floor = found["noise_floor"];
  CHECK(before > 3.0 * floor);
  CHECK(after < 1.2 * floor);
  CHECK(after > 0.8 * floor);
  CHECK(holds(ended.out, "fit 1   low.csv"));
  CHECK(holds(ended.out, "cubic stiffness"));
  CHECK(holds(folder.read("out/graph.yaml"), "trace.select"));
}

TEST_CASE("trace of a plant that lacks nothing says so, as JSON") {
  const Folder folder;
  write_experiment(folder, 0.0);
  const auto ended =
      run_bodeflow(words({"trace", "--model", "residual.second_order", "--fit", "low.csv", "high.csv", "--select", "select.csv",
                          "--test", "test.csv", "--effects", "delay,cubic_stiffness", "--json", "--set", "alpha=0.001"},
                         kColumns, kPeriodic),
                   folder.path());
  INFO(ended.err << ended.out);
  REQUIRE(ended.exit_code == 0);
  const auto printed = nlohmann::json::parse(ended.out);
  CHECK(printed["results"]["trace"]["attributes"]["verdict"] == "none");
  CHECK(printed.contains("directory"));
}

TEST_CASE("trace splits a single file itself and says how") {
  const Folder folder;
  folder.write("only.csv", oscillator_csv({0.4, 0.0, 5, 12}));
  const auto ended = run_bodeflow(
      words({"trace", "--model", "second_order", "--fit", "only.csv", "--effects", "delay", "--out", "out"}, kColumns, kPeriodic),
      folder.path());
  INFO(ended.err << ended.out);
  REQUIRE(ended.exit_code == 0);
  CHECK(trace_in(folder)["verdict"] == "none");
  CHECK(holds(ended.out + ended.err, "periods"));
}

TEST_CASE("trace refuses what it is not told rightly, with what there is") {
  const Folder folder;
  folder.write("low.csv", oscillator_csv({0.15, 0.0, 1, 1}));
  folder.write("response.csv", "f [Hz],re(G),im(G)\n1,2,3\n2,2,3\n3,1,1\n");
  const Words fit{"--fit", "low.csv"};
  const auto base = [&](const std::string& model) { return words({"trace", "--model", model}, fit, kColumns); };
  CHECK(holds(refusal(folder, base("second_ordr"), 2),
              "--model 'second_ordr': no such base model (did you mean 'residual.second_order'?); there are: "));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--declare", "outptu=velocity"}), 2),
              "residual.second_order declares no 'outptu' (did you mean 'output'?); it declares: form, output"));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--declare", "output"}), 2), "expected NAME=VALUE"));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--effects", "delay,dely"}), 2),
              "--effects dely: no such effect (did you mean 'delay'?)"));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--skip", "1"}), 2), "--skip counts periods"));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--set", "alhpa=1"}), 2),
              "has no parameter 'alhpa' (did you mean 'alpha'?)"));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--known", "fit 2: added_mass=1 g"}), 2), "no record 'fit 2'"));
  CHECK(holds(refusal(folder, words(base("second_order"), {"--known", "added_mass"}), 2), "expected 'RECORD: NAME=VALUE'"));
  CHECK(holds(refusal(folder, {"trace", "--model", "second_order", "--fit", "nowhere.csv"}, 3), "nowhere.csv: no such file"));
  folder.write("without_rate.csv", "force,position\n1,0.1\n2,0.3\n1,0.2\n0,0.1\n");
  CHECK(holds(refusal(folder, words({"trace", "--model", "second_order", "--fit", "without_rate.csv"}, kColumns), 3),
              "without_rate.csv: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give "
              "the samples per second: --rate 2500Hz"));
  CHECK(holds(refusal(folder, words({"trace", "--model", "second_order"}, fit), 3),
              "--input is missing: which column is the input?"));
  CHECK(holds(refusal(folder, {"trace", "--model", "impedance", "--fit", "response.csv", "--period", "5"}, 2),
              "--period: response.csv holds a frequency response, not samples"));
  CHECK(holds(refusal(folder, words(base("transfer_function"), {"--black-box", "nothing"}), 3),
              "nothing: no such run directory or result.json"));
  CHECK(refusal(folder, {"trace", "--fit", "low.csv"}, 2).find("--model") != std::string::npos);
}

TEST_CASE("trace refuses a wrong declaration and a file that is too short in the tracer's own words") {
  const Folder folder;
  folder.write("low.csv", oscillator_csv({0.15, 0.0, 1, 1}));
  const auto declared = run_bodeflow(
      words({"trace", "--model", "second_order", "--fit", "low.csv", "--declare", "output=velocty"}, kColumns), folder.path());
  CHECK(declared.exit_code != 0);
  CHECK(holds(declared.err,
              "base model 'residual.second_order': output: found 'velocty', allowed: displacement, velocity, acceleration (did "
              "you mean 'velocity'?)"));
}
