// Fits of measured frequency responses beside Octave (invfreqs, invfreqz, fitfrd) and scikit-rf (vector fitting): same data, same
// run, same number of poles. Prints rms errors and CPU; the figures in tests/bench/README.md come from here. A peer that is
// absent is left out, and named.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "../runtime/measure.hpp"
#include "examples.hpp"
#include "methods.hpp"
#include "peer.hpp"

namespace {

using bench::Example;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// CPU, rms and unstable poles of a call; tunings as of a peer.
struct Row {
  std::string name;
  std::function<std::optional<bench::Call>(const Example&, Eigen::Index order, int tuning)> call;
};

Row ours(const bench::Method& method) {
  return {"bodeflow " + method.name, [method](const Example& e, Eigen::Index order, int) -> std::optional<bench::Call> {
            std::optional<bench::Model> model;
            const bench::Cost cost = bench::measure(1, [&] { model = method.fit(e.data, e.ports, order); });
            if (!model) return {};
            const double rms =
                bench::errors(e.data, model->system).norm() / std::sqrt(static_cast<double>(e.data.response.size()));
            return bench::Call{cost.cpu_ns * 1e-9, rms, static_cast<int>((model->poles.real().array() > 0.0).count()), 1};
          }};
}

/// Writes the data as a peer reads them, and gives the file's name.
std::string written(const Example& e, const std::string& folder, double unit) {
  const std::string path = folder + "/data";
  std::ofstream file(path);
  for (Eigen::Index k = 0; k < e.data.lines(); ++k) {
    file << fmt::format("{:.17g}", e.data.omega_rad_s[k] / unit);
    for (const auto& value : e.data.response.row(k)) file << fmt::format(" {:.17g} {:.17g}", value.real(), value.imag());
    file << '\n';
  }
  return path;
}

void add_octave(std::vector<Row>& rows, bench::Peer& peer, const std::string& folder) {
  for (const auto& [method, note] : {std::pair{"invfreqs", "one unweighted Levi step"},
                                     std::pair{"invfreqz", "one unweighted Levi step"}, std::pair{"fitfrd", "SLICOT SB10YD"}})
    rows.push_back({fmt::format("Octave {} ({})", method, note),
                    [&peer, folder, name = std::string(method)](const Example& e, Eigen::Index order, int tuning) {
                      if (e.data.channels() > 1) return std::optional<bench::Call>();
                      return peer.call(fmt::format("{} {} {} {}", name, order, tuning, written(e, folder, 1.0)));
                    }});
}

void add_scikit_rf(std::vector<Row>& rows, bench::Peer& peer, const std::string& folder) {
  rows.push_back({"scikit-rf vector fitting", [&peer, folder](const Example& e, Eigen::Index order, int tuning) {
                    return peer.call(fmt::format("{} {} {} {}", order, tuning, e.ports, written(e, folder, kTurn)));
                  }});
}

/// The tuning with the least rms, of models without unstable poles if there are any; nothing where none gives a model.
std::optional<int> best_tuning(const Row& row, const Example& e, Eigen::Index order) {
  std::optional<int> best;
  std::optional<bench::Call> least;
  for (int tuning = 1, count = 1; tuning <= count; ++tuning) {
    const auto one = row.call(e, order, tuning);
    if (!one) return {};
    count = one->tunings;
    if (one->unstable < 0) continue;
    const bool better = !least || (one->unstable == 0) > (least->unstable == 0) ||
                        ((one->unstable == 0) == (least->unstable == 0) && one->rms < least->rms);
    if (!better) continue;
    least = one;
    best = tuning;
  }
  return best;
}

void in_turn(const Example& e, Eigen::Index order, const std::vector<Row>& rows, int repeats) {
  fmt::print("{}: {} poles, {} lines, {} x {}\n", e.name, order, e.data.lines(), e.data.channels() / e.ports, e.ports);
  fmt::print("{:<52}{:>12}{:>12}{:>10}{:>8}\n", "", "rms", "CPU ms", "unstable", "tuning");
  std::vector<std::optional<int>> tuning;
  for (const Row& row : rows) tuning.push_back(best_tuning(row, e, order));
  std::vector<std::vector<double>> cpu(rows.size());
  std::vector<bench::Call> last(rows.size());
  for (int i = 0; i < repeats; ++i)
    for (std::size_t n = 0; n < rows.size(); ++n) {
      if (!tuning[n]) continue;
      last[n] = rows[n].call(e, order, *tuning[n]).value_or(bench::Call{});
      cpu[n].push_back(1e3 * last[n].cpu_s);
    }
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (tuning[n])
      fmt::print("{:<52}{:>12.4g}{:>12.2f}{:>10}{:>8}\n", rows[n].name, last[n].rms, bench::median(cpu[n]), last[n].unstable,
                 fmt::format("{}/{}", *tuning[n], last[n].tunings));
    else
      fmt::print("{:<52}{:>12}\n", rows[n].name, "no model");
  }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) try {
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 5;
  std::string folder = (std::filesystem::temp_directory_path() / "bodeflow_bench_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return 1;
  std::vector<Row> rows;
  for (const bench::Method& method : bench::methods()) rows.push_back(ours(method));
  bench::Peer octave({"octave-cli", "--quiet", "--no-gui", std::string(BENCH_FITS) + "/peer.m"});
  bench::Peer python({"/usr/bin/python3", std::string(BENCH_FITS) + "/peer.py"});
  fmt::print("Octave: {}\n", octave.banner().empty() ? "absent, or without its packages control and signal" : octave.banner());
  fmt::print("Python: {}\n\n", python.banner().empty() ? "without scikit-rf" : python.banner());
  if (!octave.banner().empty()) add_octave(rows, octave, folder);
  if (!python.banner().empty()) add_scikit_rf(rows, python, folder);
  for (const Example& e : bench::examples())
    for (const Eigen::Index order : e.orders) in_turn(e, order, rows, repeats);
  std::filesystem::remove_all(folder);
} catch (const std::exception& problem) {
  fmt::print(stderr, "{}\n", problem.what());
  return 1;
}
