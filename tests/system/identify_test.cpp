#include <complex>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "bench_data.hpp"
#include "catch.hpp"
#include "system/command.hpp"

using namespace bodeflow::test;
using Complex = std::complex<double>;
using Words = std::vector<std::string>;

namespace {

const Words kKoopmansLevin{"identify", "bench.csv", "--input",        "voltage", "--output",
                           "current",  "--method",  "koopmans_levin", "--out",   "out"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

nlohmann::json model_in(const Folder& folder, const std::string& run = "out") {
  return nlohmann::json::parse(folder.read(run + "/result.json"))["results"]["identify"];
}

std::vector<double> list(const nlohmann::json& record, const char* name) {
  return record["arrays"][name]["data"].get<std::vector<double>>();
}

/// What the command says when it refuses.
std::string refusal(const Folder& folder, const Words& words, int code) {
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  CHECK(ended.exit_code == code);
  CHECK(ended.out.empty());
  return ended.err;
}

bool holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return true;
  UNSCOPED_INFO("'" << part << "' is not in:\n" << text);
  return false;
}

}  // namespace

TEST_CASE("identify gives a model with its covariance from a CSV of noisy signals") {
  const Folder folder;
  folder.write("bench.csv", bench_csv());
  const auto ended = run_bodeflow(with(kKoopmansLevin, {"--order", "2", "--set", "ratio=1"}), folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(holds(ended.err, "bench.csv: 3000 rows at 100 Hz"));
  CHECK(holds(ended.out, "Identify current from voltage of bench.csv by koopmans_levin.model"));
  CHECK(holds(ended.out, "Run directory: "));
  CHECK(holds(ended.out, "/out/report.html"));
  CHECK(holds(ended.out, "/out --data bench.csv --input voltage --output current"));

  const std::string page = folder.read("out/report.html");
  CHECK(holds(page, "What was done"));
  CHECK(page.find("<dt>summary</dt>") == std::string::npos);

  const auto model = model_in(folder);
  CHECK(model["type"] == "model");
  CHECK(model["attributes"]["method"] == "koopmans_levin.model");
  CHECK(model["attributes"]["order"] == 2);
  CHECK(model["attributes"]["sample_time"].get<double>() == Approx(0.01));
  CHECK(model["attributes"]["input_units"] == nlohmann::json{"V"});
  const auto numerator = list(model, "numerator"), denominator = list(model, "denominator");
  REQUIRE(denominator.size() == 3);
  CHECK(denominator[1] / denominator[0] == Approx(-1.5).epsilon(0.02));
  CHECK(denominator[2] / denominator[0] == Approx(0.7).epsilon(0.03));
  REQUIRE(numerator.size() == 3);
  CHECK(numerator[1] / denominator[0] == Approx(0.4).margin(0.03));
  const auto names = model["attributes"]["parameter_names"].get<Words>();
  const auto parameters = list(model, "parameters"), covariance = list(model, "covariance");
  CHECK(parameters.size() == names.size());
  REQUIRE(covariance.size() == names.size() * names.size());
  for (std::size_t i = 0; i < names.size(); ++i) CHECK(covariance[i * names.size() + i] > 0.0);
  const Complex pole = 100.0 * std::log(Complex(0.75, std::sqrt(0.7 - 0.75 * 0.75)));
  const auto& poles = model["arrays"]["poles"];
  CHECK(poles["unit"] == "rad/s");
  CHECK(std::abs(Complex(poles["data"][0][0], std::abs(poles["data"][0][1].get<double>())) - pole) < 0.03 * std::abs(pole));
}

TEST_CASE("identify leaves a graph that gives the same model when it is run by itself") {
  const Folder folder;
  folder.write("bench.csv", bench_csv());
  REQUIRE(run_bodeflow(with(kKoopmansLevin, {"--order", "2", "--set", "ratio=1"}), folder.path()).exit_code == 0);
  const auto again = run_bodeflow({"run", "out/graph.yaml", "--out", "again"}, folder.path());
  INFO(again.err);
  REQUIRE(again.exit_code == 0);
  CHECK(model_in(folder) == model_in(folder, "again"));
  CHECK(run_bodeflow({"rerun", "out"}, folder.path()).exit_code == 0);
}

TEST_CASE("identify averages whole periods for a method that takes a frequency response") {
  const Folder folder;
  BenchData data;
  data.period = 500;
  folder.write("bench.csv", bench_csv(data));
  const Words ask{"identify", "bench.csv", "--input", "voltage",  "--output", "current", "--method", "maximum_likelihood.model",
                  "--order",  "2",         "--set",   "domain=z", "--period", "500",     "--skip",   "1",
                  "--out",    "out"};
  const auto ended = run_bodeflow(ask, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(holds(folder.read("out/graph.yaml"), "spectrum.averaging_dft"));
  const auto model = model_in(folder);
  const auto denominator = list(model, "denominator");
  REQUIRE(denominator.size() == 3);
  CHECK(denominator[1] / denominator[0] == Approx(-1.5).epsilon(0.02));
  CHECK(denominator[2] / denominator[0] == Approx(0.7).epsilon(0.03));
  CHECK(holds(ended.out, "expected"));  // the cost beside what noise gives
}

TEST_CASE("identify measures the response of a record without period itself") {
  const Folder folder;
  BenchData data;
  data.noise = 0.02;
  folder.write("bench.csv", bench_csv(data));
  const auto ended = run_bodeflow({"identify", "bench.csv", "--input", "voltage", "--output", "current", "--method",
                                   "maximum_likelihood", "--order", "2", "--set", "domain=z", "--out", "out"},
                                  folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(holds(folder.read("out/graph.yaml"), "spectrum.local_polynomial"));
  const auto denominator = list(model_in(folder), "denominator");
  CHECK(denominator[1] / denominator[0] == Approx(-1.5).epsilon(0.02));
}

TEST_CASE("identify finds a frequency response in the file by reading it") {
  const Folder folder;
  std::vector<double> f, re, im, var;
  for (int k = 1; k <= 60; ++k) {
    const Complex s(0.0, 2.0 * std::numbers::pi * 0.5 * k);
    const Complex g = (3.0 * s + 50.0) / (s * s + 4.0 * s + 900.0);
    f.push_back(0.5 * k);
    re.push_back(g.real());
    im.push_back(g.imag());
    var.push_back(1e-8);
  }
  folder.write("plant.csv", csv_of({"f [Hz]", "re(G) [A/V]", "im(G) [A/V]", "var(G)"}, {f, re, im, var}));
  const auto ended =
      run_bodeflow({"identify", "plant.csv", "--method", "maximum_likelihood", "--order", "2", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(holds(ended.err, "60 points, 0.5 to 30 Hz"));
  CHECK(holds(ended.out, "Identify plant.csv by maximum_likelihood.model"));
  CHECK(holds(ended.out, "Next: bodeflow report "));
  const auto denominator = list(model_in(folder), "denominator"), numerator = list(model_in(folder), "numerator");
  CHECK(denominator[1] / denominator[0] == Approx(4.0).epsilon(1e-6));
  CHECK(denominator[2] / denominator[0] == Approx(900.0).epsilon(1e-6));
  CHECK(numerator.back() / denominator[0] == Approx(50.0).epsilon(1e-6));

  const Words no_samples{"identify", "plant.csv", "--method", "koopmans_levin", "--order", "2"};
  CHECK(holds(refusal(folder, no_samples, 2),
              "plant.csv holds a frequency response; koopmans_levin.model needs the samples of input and output"));
  CHECK(holds(refusal(folder, {"identify", "plant.csv", "--method", "maximum_likelihood", "--order", "2", "--period", "100"}, 2),
              "--period: plant.csv holds a frequency response, not samples"));
}

TEST_CASE("identify reads the recording of a run") {
  const Folder folder;
  folder.write("bench.yaml",
               "bodeflow: 1\nrun: {duration: 20 s}\nrecord: [excitation.out, plant.out]\nblocks:\n"
               "  excitation: {block: generators.noise, sample_rate: 100 Hz, std: 1}\n"
               "  plant: {block: plants.linear, numerator: [0.4, 0.2], denominator: [1, -1.5, 0.7], domain: discrete}\n"
               "connections: [excitation -> plant]\n");
  const auto measured = run_bodeflow({"run", "bench.yaml", "--out", "measured"}, folder.path());
  INFO(measured.err);
  REQUIRE(measured.exit_code == 0);
  const auto ended = run_bodeflow({"identify", "measured/data.h5", "--input", "excitation.out", "--output", "plant.out",
                                   "--method", "koopmans_levin", "--order", "2", "--set", "ratio=1", "--out", "out", "--json"},
                                  folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto printed = nlohmann::json::parse(ended.out);
  CHECK(holds(printed["directory"], "/out"));
  CHECK(printed["graph"] == "identify");
  const auto denominator = list(printed["results"]["identify"], "denominator");
  CHECK(denominator[1] / denominator[0] == Approx(-1.5).epsilon(1e-7));
}

TEST_CASE("identify gives the parameters of a motor at standstill from a recording with noise on voltage and current") {
  // Rs 6.6 ohm, Rr 5.5 ohm, Ls = Lr 475 mH, Lm 454 mH, as alpha = Rr/Lr, sigma = Ls - Lm^2/Lr and so on.
  const double alpha = 5.5 / 0.475, sigma = 0.475 - 0.454 * 0.454 / 0.475, lm_beta = 0.454 * 0.454 / 0.475 / sigma;
  const double gamma = 6.6 / sigma + alpha * lm_beta;
  const auto number = [](double x) { return nlohmann::json(x).dump(); };
  const Folder folder;
  folder.write(
      "bench.yaml",
      "bodeflow: 1\nrun: {duration: 60 s}\nrecord: [voltage.out, current.out]\nblocks:\n"
      "  excitation: {block: generators.multisine, sample_rate: 250 Hz, period: 1250, lines: {first: 1, last: 249, step: 2}, "
      "unit: V}\n"
      "  motor: {block: plants.linear, unit: A, numerator: [" +
          number(1.0 / sigma) + ", " + number(alpha / sigma) + "], denominator: [1, " + number(gamma + alpha) + ", " +
          number(alpha * (gamma - alpha * lm_beta)) +
          "]}\n"
          "  of_voltage: {block: generators.noise, sample_rate: 250 Hz, std: 10 mV, unit: V}\n"
          "  of_current: {block: generators.noise, sample_rate: 250 Hz, std: 0.1 mA, unit: A}\n"
          "  voltage: {block: filters.sum}\n  current: {block: filters.sum}\n"
          "connections:\n  - excitation -> motor -> current.a\n  - of_current -> current.b\n"
          "  - excitation -> voltage.a\n  - of_voltage -> voltage.b\n");
  const auto measured = run_bodeflow({"run", "bench.yaml", "--out", "measured"}, folder.path());
  INFO(measured.err);
  REQUIRE(measured.exit_code == 0);
  const auto ended =
      run_bodeflow({"identify", "measured/data.h5", "--input", "voltage.out",    "--output", "current.out",  "--method",
                    "frisch",   "--period",         "1250",    "--skip",         "2",        "--set",        "hold=4 ms",
                    "--set",    "lines.first=1",    "--set",   "lines.last=249", "--set",    "lines.step=2", "--out",
                    "out"},
                   folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto model = model_in(folder);
  CHECK(model["attributes"]["form"] == "physical");
  CHECK(model["attributes"]["parameter_names"] == nlohmann::json{"gamma", "alpha", "Lm_beta", "sigma"});
  const auto parameters = list(model, "parameters"), covariance = list(model, "covariance");
  const double truth[] = {gamma, alpha, lm_beta, sigma};
  for (std::size_t i = 0; i < 4; ++i) {
    const double deviation = std::sqrt(covariance[5 * i]);
    CHECK(deviation < 0.2 * truth[i]);
    CHECK(std::abs(parameters[i] - truth[i]) < 4.0 * deviation);
  }
  CHECK(list(model, "denominator").size() == 3);
  CHECK(holds(ended.out, "sigma"));
}

TEST_CASE("identify says what is missing, and what there is") {
  const Folder folder;
  folder.write("bench.csv", bench_csv({200, 1, 0.1, 1.0, 0}));
  const Words ask{"identify", "bench.csv", "--input", "voltage", "--output", "current"};
  const auto koopmans = with(ask, {"--method", "koopmans_levin"});

  CHECK(holds(refusal(folder, koopmans, 2), "--order is missing: the number of poles, or auto"));
  CHECK(holds(refusal(folder, with(ask, {"--method", "koopmans_lewin", "--order", "2"}), 2),
              "--method 'koopmans_lewin': no such method (did you mean 'koopmans_levin'?); methods:"));
  CHECK(holds(refusal(folder, with(ask, {"--method", "gain", "--order", "2"}), 2), "koopmans_levin.model"));
  CHECK(holds(refusal(folder, with(koopmans, {"--order", "2", "--set", "rato=1"}), 2),
              "--set rato: koopmans_levin.model has no parameter 'rato' (did you mean 'ratio'?); it has: "));
  CHECK(holds(refusal(folder, with(koopmans, {"--order", "2", "--set", "ratio"}), 2), "--set 'ratio': expected PARAM=VALUE"));
  CHECK(holds(refusal(folder, with(koopmans, {"--order", "two"}), 3), "order: 'two'"));
  CHECK(holds(refusal(folder, with(koopmans, {"--order", "2", "--skip", "1"}), 2), "--skip counts periods: it needs --period"));
  CHECK(holds(refusal(folder, with(koopmans, {"--order", "2", "--set", "band=1:2:3"}), 3), "band"));

  const Words other{"identify", "bench.csv", "--input",        "voltag",  "--output",
                    "current",  "--method",  "koopmans_levin", "--order", "2"};
  CHECK(holds(refusal(folder, other, 3),
              "no column 'voltag'; the file has t [s], voltage [V], current [A] (did you mean 'voltage [V]'?)"));
  const Words no_input{"identify", "bench.csv", "--output", "current", "--method", "koopmans_levin", "--order", "2"};
  const std::string said = refusal(folder, no_input, 3);
  CHECK(holds(said, "--input is missing: which column is the input?"));
  CHECK(holds(said, "voltage [V]"));
  const Words nowhere{"identify", "nowhere.csv", "--input", "u", "--output", "y", "--method", "koopmans_levin", "--order", "2"};
  CHECK(holds(refusal(folder, nowhere, 3), "nowhere.csv: no such file"));
  CHECK(holds(refusal(folder, with(ask, {"--order", "2"}), 2), "--method is required"));
}

TEST_CASE("identify names the line and column of a file that is broken") {
  const Folder folder;
  folder.write("bench.csv", "t [s],u [V],y [A]\n0,1,2\n0.1,1,two\n");
  const Words ask{"identify", "bench.csv", "--input", "u", "--output", "y", "--method", "koopmans_levin", "--order", "2"};
  CHECK(holds(refusal(folder, ask, 3), "bench.csv:3:7: "));
  folder.write("bench.csv", "u [V],y [A]\n1,2\n1,3\n");
  CHECK(holds(refusal(folder, ask, 3), "rate"));
  folder.write("bench.csv", "f [Hz],re(G),im(G)\n1,2,3\n2,2\n");
  CHECK(holds(refusal(folder, {"identify", "bench.csv", "--method", "maximum_likelihood", "--order", "1"}, 3), "bench.csv:3:"));
  folder.write("bench.csv", "u [V],u2 [V],y [A]\n1,2,3\n1,3,4\n2,2,2\n");
  CHECK(holds(refusal(folder,
                      {"identify", "bench.csv", "--input", "u", "--input", "u2", "--output", "y", "--rate", "1 kHz", "--method",
                       "koopmans_levin", "--order", "1"},
                      3),
              "channels"));
}

TEST_CASE("identify prints a next command that runs as typed") {
  const Folder folder;
  folder.write("bench.csv", bench_csv());
  const auto ended = run_bodeflow(with(kKoopmansLevin, {"--order", "2", "--set", "ratio=1"}), folder.path());
  REQUIRE(ended.exit_code == 0);
  const auto at = ended.out.find("bodeflow compare ");
  REQUIRE(at != std::string::npos);
  std::istringstream line(ended.out.substr(at + 9, ended.out.find('\n', at) - at - 9));
  Words words{std::istream_iterator<std::string>(line), {}};
  const auto compared = run_bodeflow(with(words, {"--out", "compared"}), folder.path());
  INFO(compared.err);
  CHECK(compared.exit_code == 0);
}

TEST_CASE("identify refuses an order that is given twice and differs") {
  const Folder folder;
  folder.write("bench.csv", bench_csv());
  CHECK(holds(refusal(folder, with(kKoopmansLevin, {"--order", "2", "--set", "order=3"}), 2),
              "--order 2 and --set order=3 contradict each other; give one of them"));
}
