// Identification of 1,000,000 lines and the Frisch walk, beside NumPy and SciPy in the same run, in turn. Prints medians; the
// figures in tests/bench/README.md come from here.

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "../runtime/measure.hpp"
#include "frisch/noise_variances.hpp"
#include "koopmans_levin/solution.hpp"
#include "koopmans_levin/time_domain.hpp"

namespace {

using bodeflow::numerics::Random;

// The peer process: a command in, the cost of one call out.
class Peer {
 public:
  Peer() {
    int to[2], from[2];
    if (pipe(to) != 0 || pipe(from) != 0) std::exit(1);
    child_ = fork();
    if (child_ == 0) {
      dup2(to[0], 0);
      dup2(from[1], 1);
      for (const int end : {to[0], to[1], from[0], from[1]}) close(end);
      execl("/usr/bin/python3", "python3", BENCH_PEER, nullptr);
      std::_Exit(127);
    }
    close(to[0]);
    close(from[1]);
    commands_ = fdopen(to[1], "w");
    answers_ = fdopen(from[0], "r");
  }
  ~Peer() {
    std::fclose(commands_);
    std::fclose(answers_);
    waitpid(child_, nullptr, 0);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Seconds of CPU and wall, and the result.
  std::vector<double> call(const std::string& command) {
    std::fprintf(commands_, "%s\n", command.c_str());
    std::fflush(commands_);
    std::vector<double> answer(3);
    if (std::fscanf(answers_, "%lf %lf %lf", &answer[0], &answer[1], &answer[2]) != 3) {
      fmt::print(stderr, "the peer gave no answer: are python3-numpy and python3-scipy installed?\n");
      std::exit(1);
    }
    return answer;
  }

 private:
  pid_t child_ = 0;
  std::FILE* commands_ = nullptr;
  std::FILE* answers_ = nullptr;
};

struct Row {
  std::string name;
  std::function<std::vector<double>()> run;  // CPU s, wall s, result
  std::vector<double> cpu, wall;
  double result = 0.0;
};

// A call done `times` times.
std::function<std::vector<double>()> ours(std::size_t times, std::function<double()> call) {
  return [=] {
    double result = 0.0;
    const bench::Cost cost = bench::measure(times, [&] {
      for (std::size_t i = 0; i < times; ++i) result = call();
    });
    return std::vector<double>{cost.cpu_ns * 1e-9, cost.wall_ns * 1e-9, result};
  };
}

void in_turn(const std::string& title, std::vector<Row> rows, int repeats) {
  for (int i = -1; i < repeats; ++i) {
    for (Row& row : rows) {
      const auto answer = row.run();
      row.result = answer[2];
      if (i < 0) continue;
      row.cpu.push_back(answer[0]);
      row.wall.push_back(answer[1]);
    }
  }
  fmt::print("{}\n{:<44}{:>12}{:>12}{:>22}\n", title, "", "CPU us", "wall us", "result");
  for (const Row& row : rows) {
    fmt::print("{:<44}{:>12.2f}{:>12.2f}{:>22.15g}\n", row.name, 1e6 * bench::median(row.cpu), 1e6 * bench::median(row.wall),
               row.result);
  }
  fmt::print("\n");
}

struct Records {
  Eigen::VectorXd u, y;
};

// The paper's Example 1 with its noise.
Records example(Eigen::Index samples) {
  Random random(1);
  Records r{Eigen::VectorXd(samples), Eigen::VectorXd(samples)};
  double u1 = 0, u2 = 0, y1 = 0, y2 = 0;
  for (Eigen::Index t = 0; t < samples; ++t) {
    const double u = random.uniform() < 0.5 ? -1.0 : 1.0, y = 0.5 * y1 - 0.3 * y2 + 2.0 * u - 1.2 * u1 - 0.6 * u2;
    u2 = u1, u1 = u, y2 = y1, y1 = y;
    r.u[t] = u + std::sqrt(0.1) * random.normal();
    r.y[t] = y + std::sqrt(0.6) * random.normal();
  }
  return r;
}

template <class Vector>
void append(std::ofstream& file, const Vector& v) {
  file.write(reinterpret_cast<const char*>(v.data()), static_cast<std::streamsize>(sizeof(v[0])) * v.size());
}

void koopmans_levin(Peer& peer, const std::string& folder, int repeats) {
  using namespace bodeflow::koopmans_levin;
  const Records r = example(1'999'998);
  const Lines lines = *lines_of(r.u, r.y);
  const std::string file = folder + "/spectra";
  {
    std::ofstream out(file, std::ios::binary);
    append(out, lines.input);
    append(out, lines.output);
  }
  for (const Eigen::Index n : {2, 4}) {
    in_turn(fmt::format("Koopmans-Levin, {} lines of the full range, order {}, from spectra to the model", lines.size(), n),
            {{"bodeflow, sums over lines", ours(1, [&] { return solve(*factors_from_sums(lines, n), 6.0)->noise; }), {}, {}},
             {"bodeflow, blocked QR", ours(1, [&] { return solve(*factors(lines, n), 6.0)->noise; }), {}, {}},
             {"bodeflow, time domain (no transform needed)",
              ours(1, [&] { return solve(*time_domain_factors(r.u, r.y, n), 6.0)->noise; }),
              {},
              {}},
             {"NumPy and SciPy, matrix product and eigh",
              [&] { return peer.call(fmt::format("koopmans_levin {} {} {}", file, lines.size(), n)); },
              {},
              {}}},
            repeats);
  }
}

bodeflow::frisch::PowerSpectra spectra(Eigen::Index lines, bool hard) {
  Random random(2);
  bodeflow::frisch::PowerSpectra s{Eigen::VectorXd(lines), Eigen::VectorXd(lines), Eigen::VectorXcd(lines)};
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double power = hard ? std::exp(0.5 * random.normal()) : 1.0, gain = std::exp(0.3 * random.normal());
    s.uu[k] = power + 0.1 * (1.0 + 0.3 * random.uniform());
    s.yy[k] = power * gain * gain + 0.05 * (1.0 + 0.3 * random.uniform());
    s.yu[k] = power * gain;
  }
  return s;
}

void frisch(Peer& peer, const std::string& folder, int repeats) {
  for (const bool hard : {false, true}) {
    for (const Eigen::Index lines : {24, 20'000}) {
      const auto s = spectra(lines, hard);
      const std::string file = folder + "/powers";
      {
        std::ofstream out(file, std::ios::binary);
        append(out, s.uu);
        append(out, s.yy);
        append(out, Eigen::VectorXd(s.yu.cwiseAbs2()));
      }
      std::vector<Row> rows = {{"bodeflow, walk on the envelope",
                                ours(lines > 1000 ? 20 : 20'000, [&] { return bodeflow::frisch::noise_variances(s)->cost; }),
                                {},
                                {}}};
      if (lines < 1000) {
        rows.push_back({"SciPy, SLSQP", [&] { return peer.call(fmt::format("frisch {} {}", file, lines)); }, {}, {}});
      }
      in_turn(fmt::format("Frisch scheme, {} lines{}", lines, hard ? ", powers that differ" : ""), rows, repeats);
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 7;
  std::string folder = (std::filesystem::temp_directory_path() / "bodeflow_bench_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return 1;
  {
    Peer peer;
    koopmans_levin(peer, folder, repeats);
    frisch(peer, folder, repeats);
  }
  std::filesystem::remove_all(folder);
}
