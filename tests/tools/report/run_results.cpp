#include "tools/report/run_results.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace bodeflow::test {
namespace {

using nlohmann::ordered_json;
using Shape = std::vector<int>;

ordered_json array_of(const std::string& unit, const Shape& shape, ordered_json data) {
  return {{"unit", unit}, {"shape", shape}, {"data", std::move(data)}};
}

/// A list of `count` numbers from a function of the index.
template <class F>
ordered_json list(int count, F value) {
  ordered_json data = ordered_json::array();
  for (int n = 0; n < count; ++n) data.push_back(value(n));
  return data;
}

constexpr int kLines = 40;

double frequency(int k) { return 5.0 + 5.0 * k; }

/// A resonance at 60 Hz behind a delay.
std::complex<double> plant(double f) {
  const std::complex<double> s(0.0, 2.0 * std::numbers::pi * f / (2.0 * std::numbers::pi * 60.0));
  return std::polar(1.0, -0.004 * f) / (s * s + 0.04 * s + 1.0);
}

ordered_json complex_json(std::complex<double> z) { return {z.real(), z.imag()}; }

ordered_json spectral_levels() {
  const int lines = 60;
  ordered_json record{{"type", "spectral_levels"},
                      {"attributes",
                       {{"periods", 6},
                        {"realisations", 1},
                        {"output_names", {"angle"}},
                        {"input_name", "current"},
                        {"warnings", ordered_json::array()}}}};
  ordered_json& arrays = record["arrays"];
  const auto kind = [](int k) { return k % 2 == 0 ? (k % 8 == 4 ? 1 : 0) : 2; };
  arrays["frequency"] = array_of("Hz", {lines}, list(lines, [](int k) { return 5.0 + k; }));
  arrays["line"] = array_of("", {lines}, list(lines, [](int k) { return 5 + k; }));
  arrays["kind"] = array_of("", {lines}, list(lines, kind));
  arrays["output_level"] = array_of("rad", {lines, 1}, list(lines, [&](int k) {
                                      return kind(k) == 0 ? 1.0 : kind(k) == 1 ? 0.17 : 0.06;
                                    }));
  arrays["output_noise"] = array_of("rad", {lines, 1}, list(lines, [](int) { return 0.01; }));
  arrays["input_level"] = array_of("A", {lines}, list(lines, [&](int k) { return kind(k) == 0 ? 2.0 : 0.001; }));
  arrays["input_noise"] = array_of("A", {lines}, list(lines, [](int) { return 0.001; }));
  return record;
}

ordered_json spectral_matrix() {
  ordered_json record{
      {"type", "spectral_matrix"},
      {"attributes",
       {{"signal_names", {"current", "angle"}}, {"signal_units", {"A", "rad"}}, {"windows", 8}, {"sample_rate", 1000.0}}}};
  ordered_json& arrays = record["arrays"];
  arrays["frequency"] = array_of("Hz", {kLines}, list(kLines, frequency));
  arrays["matrix"] =
      array_of("", {kLines, 2, 2}, list(4 * kLines, [](int n) { return complex_json(n % 4 == 0 || n % 4 == 3 ? 1.0 : 0.1); }));
  arrays["noise_covariance"] = array_of("", {kLines, 2, 2}, list(4 * kLines, [](int) { return complex_json(1e-6); }));
  return record;
}

ordered_json model() {
  const double w = 2.0 * std::numbers::pi * 60.0;
  ordered_json record{{"type", "model"},
                      {"attributes",
                       {{"method", "frisch.fit"},
                        {"form", "transfer_function"},
                        {"order", 2},
                        {"sample_time", 0.0},
                        {"delay", 0.0006},
                        {"parameter_names", {"gain", "stiffness"}},
                        {"conventions", {"continuous in time"}},
                        {"cost", 120.0},
                        {"expected_cost", 76.0},
                        {"cost_degrees_of_freedom", 152.0},
                        {"warnings", {"a mode may be missing near 150 Hz: raise the order"}}}}};
  ordered_json& arrays = record["arrays"];
  arrays["numerator"] = array_of("", {1}, {w * w});
  arrays["denominator"] = array_of("", {3}, {1.0, 0.04 * w, w * w});
  arrays["parameters"] = array_of("", {2}, {1.0, 250.0});
  arrays["covariance"] = array_of("", {2, 2}, {1e-4, 0.0, 0.0, 4.0});
  const double re = -0.02 * w, im = w * std::sqrt(1.0 - 0.02 * 0.02);
  arrays["poles"] = array_of("rad/s", {2}, {{re, im}, {re, -im}});
  arrays["pole_covariance"] = array_of("", {2, 2, 2}, {1.0, 0.2, 0.2, 4.0, 1.0, -0.2, -0.2, 4.0});
  return record;
}

ordered_json discrete_model() {
  ordered_json record{{"type", "model"},
                      {"attributes", {{"method", "subspace.fit"}, {"form", "state_space"}, {"sample_time", 0.002}}}};
  ordered_json& arrays = record["arrays"];
  arrays["A"] = array_of("", {2, 2}, {0.7, 0.6, -0.6, 0.7});
  arrays["B"] = array_of("", {2, 1}, {1.0, 0.0});
  arrays["C"] = array_of("", {1, 2}, {0.1, 0.2});
  arrays["D"] = array_of("", {1, 1}, {0.0});
  arrays["poles"] = array_of("", {2}, {{0.7, 0.6}, {0.7, -0.6}});
  return record;
}

ordered_json monte_carlo() {
  ordered_json record{{"type", "monte_carlo"},
                      {"attributes", {{"runs", 100}, {"seed", 1}, {"quantity_names", {"inertia", "stiffness"}}}}};
  for (const char* name : {"mean", "std", "truth", "published_mean", "published_std", "predicted_std"})
    record["arrays"][name] = array_of("", {2}, {0.0012, 512.0});
  record["arrays"]["coverage"] = array_of("", {2}, {0.94, nullptr});
  return record;
}

/// Two models held against data.
ordered_json comparison() {
  const int samples = 80, lags = 10;
  ordered_json record{{"type", "comparison"},
                      {"attributes",
                       {{"models", {"first", "second"}},
                        {"methods", {"a.model", "a.model"}},
                        {"parameter_names", {"gain", "corner"}},
                        {"parameter_units", {"1", "rad/s"}},
                        {"output_names", {"angle"}},
                        {"output_units", {"rad"}},
                        {"steps", 10},
                        {"samples", samples},
                        {"sample_rate", 1000.0},
                        {"confidence", 0.99},
                        {"estimated", "initial state and output offset, from these data"},
                        {"noise_models", {"white noise", "autoregression of order 3"}},
                        {"noise_models_from", "the simulation's residual of these data, order by AICc"},
                        {"warnings", ordered_json::array()}}}};
  ordered_json& arrays = record["arrays"];
  for (const char* name : {"fit", "prediction_fit", "residual_std", "prediction_std", "expected_prediction_std", "fpe", "aic",
                           "whiteness_probability", "cross_outside", "input_outside_band"})
    arrays[name] = array_of("", {2}, {0.9, 0.01});
  arrays["output_outside_band"] = array_of("", {2}, {0.2, nullptr});
  arrays["autocorrelation_band"] = arrays["cross_correlation_band"] = array_of("", {2}, {0.1, 0.1});
  arrays["parameters"] = array_of("", {2, 2}, {1.0, 50.0, 1.1, nullptr});
  arrays["parameter_std"] = array_of("", {2, 2}, {0.01, 1.0, 0.02, nullptr});
  arrays["parameter_difference"] = array_of("", {2, 2}, {nullptr, nullptr, 4.5, nullptr});
  arrays["parameter_probability"] = array_of("", {2}, {nullptr, 1e-5});
  arrays["poles"] = array_of("rad/s", {2, 1}, {{-2.0, 40.0}, {nullptr, nullptr}});
  const auto wave = [](int n) { return std::sin(0.3 * n); };
  arrays["time"] = array_of("s", {samples}, list(samples, [](int n) { return 0.001 * n; }));
  arrays["measured"] = array_of("rad", {samples}, list(samples, wave));
  arrays["simulated"] = array_of("rad", {2, samples}, list(2 * samples, [&](int n) { return 0.98 * wave(n % samples); }));
  arrays["predicted"] = array_of("rad", {2, samples}, list(2 * samples, [&](int n) { return 0.99 * wave(n % samples); }));
  arrays["lag"] = array_of("", {2 * lags + 1}, list(2 * lags + 1, [&](int n) { return double(n - lags); }));
  arrays["cross_correlation"] = array_of("", {2, 2 * lags + 1}, list(4 * lags + 2, [&](int n) { return 0.05 * wave(n); }));
  arrays["innovation_autocorrelation"] =
      array_of("", {2, lags + 1}, list(2 * lags + 2, [&](int n) { return n % (lags + 1) == 0 ? 1.0 : 0.02; }));
  arrays["frequency"] = array_of("Hz", {kLines}, list(kLines, frequency));
  arrays["response"] =
      array_of("rad/A", {2, kLines}, list(2 * kLines, [](int n) { return complex_json(plant(frequency(n % kLines))); }));
  return record;
}

ordered_json order_scan() {
  ordered_json record{{"type", "order_scan"},
                      {"attributes", {{"chosen", 2}, {"rule", "the lowest that no higher one undercuts"}}}};
  ordered_json& arrays = record["arrays"];
  arrays["order"] = array_of("1", {4}, {1.0, 2.0, 3.0, 4.0});
  arrays["cost"] = array_of("1", {4}, {9e3, 102.0, 100.0, 99.0});
  arrays["expected_cost"] = array_of("1", {4}, {104.0, 102.0, 100.0, 98.0});
  arrays["cost_probability"] = array_of("1", {4}, {0.0, 0.5, 0.5, 0.4});
  arrays["aic"] = array_of("1", {4}, {9.1e3, 110.0, nullptr, 113.0});
  return record;
}

ordered_json residual() {
  ordered_json record{{"type", "residual"}, {"attributes", {{"output_names", {"angle"}}, {"input_name", "current"}}}};
  ordered_json& arrays = record["arrays"];
  arrays["frequency"] = array_of("Hz", {kLines}, list(kLines, frequency));
  arrays["relative_error"] = array_of("1", {kLines, 1}, list(kLines, [](int n) { return 0.01 * (1.0 + n % 3); }));
  arrays["band"] = array_of("Hz", {2, 2}, {5.0, 100.0, 105.0, 200.0});
  arrays["band_relative_error"] = array_of("1", {2, 1}, {0.02, 0.03});
  arrays["band_residual"] = array_of("1", {2, 1}, {0.9, 1.1});
  return record;
}

ordered_json whiteness() {
  ordered_json record{{"type", "whiteness"},
                      {"attributes", {{"statistic", 15.4}, {"degrees_of_freedom", 19}, {"probability", 0.7}}}};
  record["arrays"]["frequency"] = array_of("Hz", {kLines}, list(kLines, frequency));
  record["arrays"]["power"] = array_of("1", {kLines}, list(kLines, [](int n) { return 1.0 + 0.01 * (n % 5); }));
  return record;
}

ordered_json sweep() {
  ordered_json record{{"type", "sweep"}, {"attributes", {{"of", "frequency_response"}, {"runs", 3}}}};
  ordered_json& arrays = record["arrays"];
  arrays["axis.gain"] = array_of("", {3}, {0.5, 1.0, 2.0});
  arrays["periods"] = array_of("", {3}, {4.0, 4.0, 4.0});
  arrays["frequency"] = array_of("Hz", {3, kLines}, list(3 * kLines, [](int n) { return frequency(n % kLines); }));
  arrays["response"] =
      array_of("", {3, kLines, 1, 1},
               list(3 * kLines, [](int n) { return complex_json((1.0 + n / kLines) * plant(frequency(n % kLines))); }));
  return record;
}

/// Two filters, one of them zero at the last frequency.
ordered_json filters() {
  const int lines = 50, samples = 20;
  return {{"type", "filter"},
          {"attributes", {{"kind", "two low passes"}, {"sample_rate", 1000.0}, {"names", {"slow", "fast"}}}},
          {"arrays",
           {{"frequency", array_of("Hz", {lines}, list(lines, [](int k) { return 10.0 * (k + 1); }))},
            {"response", array_of("", {lines, 2},
                                  list(2 * lines,
                                       [](int n) {
                                         const double f = 10.0 * (n / 2 + 1);
                                         const std::complex<double> low =
                                             1.0 / std::complex<double>(1.0, f / (n % 2 == 0 ? 20.0 : 80.0));
                                         return complex_json(n == 2 * lines - 1 ? std::complex<double>() : low);
                                       }))},
            {"time", array_of("s", {samples}, list(samples, [](int n) { return 1e-3 * n; }))},
            {"impulse", array_of("", {samples, 2}, list(2 * samples, [](int n) { return std::pow(0.8, n / 2); }))}}}};
}

}  // namespace

const char* const kHostile = "</title></style><script>alert(1)</script>\"'><img src=x onerror=alert(2)>&amp;{}]]>";

ordered_json response_record(int outputs, int inputs) {
  const int pairs = outputs * inputs, count = kLines * pairs;
  ordered_json record{{"type", "frequency_response"},
                      {"attributes",
                       {{"form", "errors_in_variables"},
                        {"method", "spectrum.averaging_dft"},
                        {"periods", 6},
                        {"realisations", 1},
                        {"confidence", 0.95},
                        {"degrees_of_freedom", 5.0},
                        {"warnings", {"only 6 periods: measure 12"}}}}};
  for (int i = 0; i < outputs; ++i) record["attributes"]["output_names"].push_back("angle" + std::to_string(i + 1));
  for (int j = 0; j < inputs; ++j) record["attributes"]["input_names"].push_back("current" + std::to_string(j + 1));
  record["attributes"]["response_units"] = list(pairs, [](int) { return "rad/A"; });
  ordered_json& arrays = record["arrays"];
  const Shape shape{kLines, outputs, inputs}, of_outputs{kLines, outputs};
  arrays["frequency"] = array_of("Hz", {kLines}, list(kLines, frequency));
  arrays["response"] =
      array_of("rad/A", shape, list(count, [&](int n) { return complex_json(plant(frequency(n / pairs)) / (1.0 + n % pairs)); }));
  arrays["variance"] = array_of("", shape, list(count, [](int n) { return 1e-4 * (1.0 + n % 7); }));
  // The last line's region holds zero
  arrays["confidence_radius"] =
      array_of("rad/A", shape, list(count, [&](int n) { return n / pairs == kLines - 1 ? 1.0 : 0.02; }));
  arrays["noise_variance"] = array_of("", shape, list(count, [](int) { return 5e-5; }));
  arrays["nonlinear_variance"] = array_of("", shape, list(count, [](int) { return 3e-4; }));
  arrays["coherence"] = array_of("", of_outputs, list(kLines * outputs, [](int n) { return 0.95 + 0.001 * (n % 40); }));
  for (const auto& [name, level] : {std::pair{"noise_level", 0.001}, {"odd_distortion", 0.017}, {"even_distortion", 0.006}})
    arrays[name] =
        array_of("rad", of_outputs, list(kLines * outputs, [&, size = level](int n) { return size * (1.0 + 0.1 * (n % 5)); }));
  arrays["output_mean"] = array_of("rad", of_outputs, list(kLines * outputs, [](int n) { return complex_json(0.5 + 0.01 * n); }));
  return record;
}

namespace {

/// Two bands of three lines each; curves of four points.
ordered_json noise_variances() {
  ordered_json record{
      {"type", "noise_variances"},
      {"attributes", {{"bands", {"0.1 to 5 Hz", "5 to 100 Hz"}}, {"input_name", "voltage"}, {"output_name", "current"}}}};
  ordered_json& arrays = record["arrays"];
  for (const char* name : {"first", "second", "pooled"}) {
    arrays[std::string("input_") + name] = array_of("V", {2}, {0.7, 0.5});
    arrays[std::string("output_") + name] = array_of("A", {2}, {0.2, 0.1});
  }
  arrays["band"] = array_of("", {6}, {0, 0, 0, 1, 1, 1});
  arrays["curve_input"] = array_of("V^2", {6, 4}, list(24, [](int n) { return 0.3 * (n % 4); }));
  arrays["curve_output"] = array_of("A^2", {6, 4}, list(24, [](int n) { return 0.02 * (3 - n % 4) * (1 + n / 8); }));
  return record;
}

}  // namespace

ordered_json results_of_all_types() {
  ordered_json results;
  results["response"] = response_record(1, 1);
  results["matrix"] = response_record(3, 3);
  results["levels"] = spectral_levels();
  results["spectra"] = spectral_matrix();
  results["fit"] = model();
  results["discrete"] = discrete_model();
  results["study"] = monte_carlo();
  results["beside"] = comparison();
  results["orders"] = order_scan();
  results["left"] = residual();
  results["white"] = whiteness();
  results["gains"] = sweep();
  results["noise"] = noise_variances();
  results["controller"] = {
      {"type", "controller"},
      {"attributes", {{"sample_time", 0.001}, {"accepted", false}, {"reason", "phase margin 21 degrees"}}},
      {"arrays",
       {{"R", array_of("", {2}, {1.0, -0.5})}, {"S", array_of("", {2}, {3.0, -2.0})}, {"T", array_of("", {1}, {1.0})}}}};
  results["trace"] = {
      {"type", "trace"},
      {"attributes",
       {{"verdict", "named"},
        {"effects", {"dead_time"}},
        {"unit", "V"},
        {"error_before", 0.3},
        {"error_after", 0.02},
        {"error_remedied", nullptr},
        {"noise_floor", 0.019},
        {"records", {"fit 1", "select", "test"}},
        {"map_signals", {"input", "slope of the output"}},
        {"map_units", {"V", "A/s"}},
        {"course_axis", "period"},
        {"course_noise", 0.04},
        {"autocorrelation_band", 0.06}}},
      {"arrays",
       {{"effect_parameters", array_of("s", {1}, {1.5e-6})},
        {"effect_parameter_std", array_of("s", {1}, {1e-7})},
        {"record_error_before", array_of("V", {3}, {0.31, 0.29, 0.3})},
        {"record_error_after", array_of("V", {3}, {0.02, 0.021, 0.02})},
        {"record_noise", array_of("V", {3}, {0.019, 0.019, 0.019})},
        {"map_at", array_of("", {2, 24}, list(48, [](int n) { return (n % 24 - 12) * (n < 24 ? 1.0 : 1500.0); }))},
        {"map_before", array_of("V", {2, 24}, list(48, [](int n) { return n % 24 < 12 ? -0.2 : 0.2; }))},
        {"map_before_std", array_of("V", {2, 24}, list(48, [](int) { return 0.01; }))},
        {"map_after", array_of("V", {2, 24}, list(48, [](int n) { return 0.002 * std::sin(n); }))},
        {"map_after_std", array_of("V", {2, 24}, list(48, [](int) { return 0.01; }))},
        {"course_at", array_of("", {6}, {1, 2, 3, 4, 5, 6})},
        {"course_before", array_of("V", {6}, {0.3, 0.3, 0.31, 0.3, 0.29, 0.3})},
        {"course_after", array_of("V", {6}, {0.041, 0.04, 0.042, 0.04, 0.039, 0.04})},
        {"autocorrelation_lag", array_of("s", {40}, list(40, [](int n) { return 1e-4 * (n + 1); }))},
        {"autocorrelation_before", array_of("1", {40}, list(40, [](int n) { return std::cos(0.2 * n); }))},
        {"autocorrelation_after", array_of("1", {40}, list(40, [](int n) { return 0.05 * std::sin(1.7 * n); }))}}}};
  results["smoothing"] = filters();
  results["lag"] = {{"type", "delay_estimate"},
                    {"attributes", {{"delay", 0.0008}, {"standard_deviation", 1e-6}}},
                    {"arrays", ordered_json::object()}};
  results["news"] = {{"type", "something_new"},
                     {"attributes", {{"level", 1.5}, {"names", {"a", "b"}}}},
                     {"arrays",
                      {{"time", array_of("s", {50}, list(50, [](int n) { return 0.1 * n; }))},
                       {"signal", array_of("V", {50}, list(50, [](int n) { return std::sin(0.3 * n); }))},
                       {"matrix", array_of("", {2, 2}, {1.0, 2.0, 3.0, 4.0})}}}};
  return results;
}

ordered_json result_with(const ordered_json& results, const std::string& status) {
  return {{"bodeflow", 1}, {"graph", "all_types"}, {"status", status}, {"results", results}};
}

}  // namespace bodeflow::test
