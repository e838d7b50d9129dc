// Examples 1 to 3 of D. A. Jue and the transformer ladders, by Sanathanan-Koerner and vector fitting.

#include "../../plugins/sanathanan_koerner/systems.hpp"
#include "../runtime/measure.hpp"
#include "figure.hpp"
#include "sanathanan_koerner/fit.hpp"
#include "sanathanan_koerner/multi_band.hpp"
#include "sanathanan_koerner/vector_fitting.hpp"

namespace {

using namespace bodeflow;
using bench::figure;
using namespace bodeflow::sanathanan_koerner;

template <class Call>
auto timed(Call call, double& cpu_ms) {
  std::optional<decltype(call())> result;
  cpu_ms = 1e-6 * bench::measure(1, [&] { result.emplace(call()); }).cpu_ns;
  return std::move(**result);
}

int iterations_to(const Course& course, double goal) {
  for (std::size_t i = 0; i < course.errors.size(); ++i)
    if (course.errors[i] <= goal) return static_cast<int>(i) + 1;
  return 1000;
}

double unstable(const Eigen::VectorXcd& poles) { return static_cast<double>((poles.real().array() >= 0.0).count()); }

/// [A1], [A2], [A4], [A6]: 90 modes of three inputs and two outputs.
void example_2() {
  const Data data = test::example_2();
  const Eigen::VectorXcd truth = test::modal_poles("ex2_system.csv");
  const Plane plane{127.0, 0.0};
  double cpu = 0.0;
  const Fit sk = timed([&] { return fit(data, plane, {180, 1.0, true, {}}); }, cpu);
  figure("A1 example 2, 180 poles: Sanathanan-Koerner, relative error", sk.error(), 1e-12, cpu);
  figure("A1   its iterations to 1e-12", iterations_to(sk.course, 1e-12), 12);
  figure("A1   its unstable poles", unstable(sk.poles), 0);
  figure("A1   its poles, largest relative distance", test::worst_match(sk.poles, truth), 1e-5);
  figure("A1   its CPU, ms", cpu, 2000);
  const VectorFit vf = timed([&] { return vector_fit(data, {180, Spacing::linear, true, {}}); }, cpu);
  figure("A1 example 2, 180 poles: vector fitting, relative error", vf.error(), 1e-12, cpu);
  figure("A1   its iterations to 1e-12", iterations_to(vf.course, 1e-12), 8);
  figure("A1   its unstable poles", unstable(all_poles(vf.model.poles)), 0);
  figure("A1   its poles, largest relative distance", test::worst_match(all_poles(vf.model.poles), truth), 1e-5);
  figure("A1   its CPU, ms", cpu, 800);
  for (const auto& [order, limit] : {std::pair<Eigen::Index, double>{118, 1.3e-3}, {58, 0.065}}) {
    const Fit one = timed([&, n = order] { return fit(data, plane, {n, 1.0, true, {}}); }, cpu);
    figure(fmt::format("A2 example 2, {} poles, one band", order), one.error(), limit, cpu);
  }
  MultiBandSettings bands;
  bands.cuts_rad_s = {28.64, 234.43};
  bands.orders = {21, 68, 29};
  bands.prewarps_rad_s = {10.0, 87.0, 245.0};
  bands.rounds = 8;
  const MultiBandFit sum = timed([&] { return multi_band_fit(data, bands); }, cpu);
  figure("A4 example 2, bands of 21, 68, 29 poles, 8 rounds", sum.error, 0.02, cpu);

  Data noisy = data;
  numerics::Random random(2);
  const double size = 1e-3 * data.response.norm() / std::sqrt(static_cast<double>(data.response.size()));
  for (std::complex<double>& g : noisy.response.reshaped())
    g += size * test::complex_normal(random) + 1e-5 * std::abs(g) * test::complex_normal(random);
  const Fit near = timed([&] { return fit(noisy, plane, {180, 1.0, true, {}}); }, cpu);
  figure("A6 example 2, .1 % noise, 180 poles: error to the truth", test::relative_error(near.response, data.response), 6e-4,
         cpu);
  const VectorFit near_vf = timed([&] { return vector_fit(noisy, {180, Spacing::linear, true, {}}); }, cpu);
  figure("A6   vector fitting", test::relative_error(near_vf.response, data.response), 6e-4, cpu);
}

/// [A3]: three groups of 18 modes.
void example_1() {
  const Data data = test::modal_data("ex1_system.csv", 1, 1, test::geometric(0.5, 2000.0, 1500));
  double cpu = 0.0;
  const Fit sk = timed([&] { return fit_with_scan(data, {108, 1.0, true, {}}); }, cpu);
  figure("A3 example 1, 108 poles: Sanathanan-Koerner from several starts", sk.error(), 1e-12, cpu);
  const VectorFit vf = timed([&] { return vector_fit(data, {108, Spacing::automatic, true, {}}); }, cpu);
  figure("A3   vector fitting from several starts", vf.error(), 1e-12, cpu);
}

struct Noisy {
  Data exact, noisy;
};

/// Columns: omega, exact response, noisy response.
Noisy noisy_of(const std::string& file) {
  const auto rows = test::table_of(file);
  const auto lines = static_cast<Eigen::Index>(rows.size());
  Eigen::VectorXd omega(lines);
  Eigen::MatrixXcd exact(lines, 1), noisy(lines, 1);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const auto& row = rows[static_cast<std::size_t>(k)];
    omega[k] = row[0];
    exact(k, 0) = {row[1], row[2]};
    noisy(k, 0) = {row[3], row[4]};
  }
  return {test::data_of(omega, exact), test::data_of(omega, noisy)};
}

double rms(const Eigen::MatrixXcd& found, const Eigen::MatrixXcd& truth) {
  return (found - truth).norm() / std::sqrt(static_cast<double>(truth.size()));
}

void example_3() {
  double cpu = 0.0;
  for (const auto& [file, limit] : {std::pair{"ex3_frf_N1.csv", 9e-4}, {"ex3_frf_N3200.csv", 4e-5}}) {
    const Noisy d = noisy_of(file);
    const Fit sk = timed([&] { return fit_with_scan(d.noisy, {120, 1.0, true, {}}); }, cpu);
    figure(fmt::format("A6 example 3 ({}), 120 poles: error to the truth", file),
           test::relative_error(sk.response, d.exact.response), limit, cpu);
    const VectorFit vf = timed([&] { return vector_fit(d.noisy, {120, Spacing::automatic, true, {40}}); }, cpu);
    figure("A6   vector fitting", test::relative_error(vf.response, d.exact.response), limit, cpu);
  }
}

/// [B2] of the iterative methods: rms error to the truth.
void ladders() {
  double cpu = 0.0;
  for (const auto& [order, limit] : {std::pair<Eigen::Index, double>{6, 1.1e-3}, {17, 3e-7}, {31, 1.1e-6}}) {
    const Noisy d = noisy_of(fmt::format("ladder{}_frf.csv", order));
    const double greatest = d.exact.response.cwiseAbs().maxCoeff();
    const FitSettings settings{order, 1.0, true, {}};
    const VectorFittingSettings vf_settings{order, Spacing::automatic, true, {40}};
    const Fit exact = timed([&] { return fit_with_scan(d.exact, settings); }, cpu);
    figure(fmt::format("B2 ladder, {} poles, exact: Sanathanan-Koerner, rms over the largest |G|", order),
           rms(exact.response, d.exact.response) / greatest, 1e-10, cpu);
    const VectorFit exact_vf = timed([&] { return vector_fit(d.exact, vf_settings); }, cpu);
    figure("B2   vector fitting", rms(exact_vf.response, d.exact.response) / greatest, 1e-10, cpu);
    const Fit sk = timed([&] { return fit_with_scan(d.noisy, settings); }, cpu);
    figure(fmt::format("B2 ladder, {} poles, .1 % noise: Sanathanan-Koerner, rms to the truth", order),
           rms(sk.response, d.exact.response), limit, cpu);
    const VectorFit vf = timed([&] { return vector_fit(d.noisy, vf_settings); }, cpu);
    figure("B2   vector fitting", rms(vf.response, d.exact.response), limit, cpu);
  }
}

}  // namespace

int main() {
  bench::heading();
  example_2();
  example_1();
  example_3();
  ladders();
}
