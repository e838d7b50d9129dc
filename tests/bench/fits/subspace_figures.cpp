// Subspace identification, realisation and reduction.

#include <sys/resource.h>

#include <bodeflow/numerics/balanced_truncation.hpp>

#include "../../plugins/subspace/systems.hpp"
#include "../runtime/measure.hpp"
#include "figure.hpp"
#include "sanathanan_koerner/fit.hpp"

namespace {

using namespace bodeflow;
using bench::figure;
using namespace bodeflow::subspace;
using test::Complex;

const Eigen::VectorXd& omega() {
  static const Eigen::VectorXd w = test::geometric(0.5, 600.0, 1200);
  return w;
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Four modes of so many inputs and outputs, 0.3 to 20 rad/s.
numerics::PoleResidue order_8(Eigen::Index size) {
  numerics::Random random(17);
  numerics::PoleResidue system;
  system.poles.resize(4);
  system.D = Eigen::MatrixXd::Constant(size, size, 0.3);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double w = 0.3 * std::pow(4.0, static_cast<double>(i));
    system.poles[i] = w * Complex(-0.03, 1.0);
    Eigen::VectorXcd left(size);
    Eigen::RowVectorXcd right(size);
    for (Complex& x : left) x = Complex(random.normal(), random.normal());
    for (Complex& x : right) x = w * Complex(random.normal(), random.normal());
    system.residues.emplace_back(left * right);
  }
  return system;
}

/// The model of that order with q functions, and its CPU time in ms.
Model subspace_model(const Lines& lines, Eigen::Index functions, Eigen::Index order, double& cpu_ms) {
  std::optional<Model> model;
  cpu_ms = 1e-6 * bench::measure(1, [&] {
                    const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
                    const auto range = range_of(lines, plane, functions, Basis::arnoldi);
                    model.emplace(*model_of_order(lines, plane, *range, order, Stability::project));
                  }).cpu_ns;
  return std::move(*model);
}

void long_data() {
  const Lines lines = test::lines_of(order_8(1), test::geometric(0.1, 30.0, 100'000));
  const double before = peak_mib();
  double cpu = 0.0;
  const Model model = subspace_model(lines, 200, 8, cpu);
  figure("B4 100,000 lines, 200 functions: poles, largest relative distance", test::pole_error(model.poles, order_8(1).poles),
         1e-10, cpu);
  figure("B4   its CPU, s", 1e-3 * cpu, 5);
  figure(fmt::format("B4   peak memory of the process, MiB ({:.0f} of them before)", before), peak_mib(), 200);
}

void small_system() {
  const Lines lines = test::lines_of(order_8(2), test::geometric(0.1, 30.0, 60));
  const Eigen::VectorXd other = test::geometric(0.13, 27.0, 173);
  double worst = 0.0, cpu = 0.0;
  for (const Eigen::Index functions : {8, 12, 20, 40}) {
    const Model model = subspace_model(lines, functions, 8, cpu);
    worst = std::max(worst, test::relative(response_of(model.system, other), test::lines_of(order_8(2), other).response));
  }
  figure("B1 order 8, 2 x 2, 60 lines, 8 to 40 functions: error on another grid", worst, 1e-10, cpu);
}

void ladders() {
  for (const auto& [order, limit] : {std::pair<Eigen::Index, double>{6, 1.1e-3}, {17, 4e-7}, {31, 1.5e-6}}) {
    const Eigen::MatrixXd rows = test::table(fmt::format("ladder{}_frf.csv", order));
    Lines exact{rows.col(0), Eigen::MatrixXcd(rows.rows(), 1), 1, Eigen::VectorXd::Ones(rows.rows())}, noisy = exact;
    exact.response.real() = rows.col(1);
    exact.response.imag() = rows.col(2);
    noisy.response.real() = rows.col(3);
    noisy.response.imag() = rows.col(4);
    const auto error = [&](const Model& model) {
      return (model.response - exact.response).norm() / std::sqrt(static_cast<double>(exact.size()));
    };
    double cpu = 0.0;
    const Model true_model = subspace_model(exact, 40, order, cpu), model = subspace_model(noisy, 40, order, cpu);
    figure(fmt::format("B2 ladder, order {}, exact: subspace, rms over the largest |G|", order),
           error(true_model) / exact.response.cwiseAbs().maxCoeff(), 1e-10, cpu);
    figure(fmt::format("B2 ladder, order {}, .1 % noise: subspace, rms to the truth", order), error(model), limit, cpu);
  }
}

numerics::StateSpace realised(const Eigen::VectorXcd& poles, double tolerance) {
  const Eigen::VectorXd hertz = omega() / (2.0 * std::numbers::pi);
  const auto residues =
      numerics::residues_by_least_squares(poles, hertz, numerics::frequency_response(test::example_2(), hertz), {});
  return *numerics::gilbert_realisation(*residues, tolerance);
}

void example_2() {
  const Lines lines = test::lines_of(test::example_2(), omega());
  double cpu = 0.0;
  const Model model = subspace_model(lines, 200, 180, cpu);
  figure("B3 example 2, 200 functions, 180 states: error", test::relative(model.response, lines.response), 1e-11, cpu);

  const numerics::StateSpace minimal = realised(test::example_2().poles, 1e-5);
  figure("A5 example 2, Gilbert's realisation: states", static_cast<double>(minimal.states()), 180);
  figure("A5   its error", test::relative(response_of(minimal, omega()), lines.response), 1e-7);
  sanathanan_koerner::FitSettings settings;
  settings.order = 118;
  const auto found = fit({lines.omega_rad_s, lines.response, lines.weight}, {127.0, 0.0}, settings);
  const numerics::StateSpace large = realised(*numerics::upper_poles(found->poles), 1e-4);
  const Eigen::MatrixXcd full = response_of(large, omega());
  figure("A5 118 poles, Gilbert's realisation: states", static_cast<double>(large.states()), 236);
  figure("A5   its error", test::relative(full, lines.response), 1.3e-3);
  const auto reduced = numerics::balanced_truncation(large, 180);
  figure("A5   truncated to 180 states: change", test::relative(response_of(reduced->system, omega()), full), 1e-3);
}

}  // namespace

int main() {
  bench::heading();
  long_data();  // first: the peak of memory is that of the process
  small_system();
  ladders();
  example_2();
}
