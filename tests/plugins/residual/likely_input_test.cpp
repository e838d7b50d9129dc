#include "periodic/likely_input.hpp"

#include "catch.hpp"
#include "periodic/fourier.hpp"
#include "periodic_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::small;

namespace {

/// The mass on a spring that stiffens by k3 x^3, its input measured with noise.
struct Stiffening {
  std::shared_ptr<Mass> base = std::make_shared<Mass>();
  JointModel model{base, {}};
  Eigen::VectorXd values, u = multisine(1.0, 1);
  PeriodicRecord record;

  Stiffening() {
    base->declared.hold = Hold::zero_order;
    auto [cubic, law] = made(Acts::law, 1, 1);
    law->law = [](const double* p, const Signals& s, const double*, double*) {
      return Reaction{p[0] * s.stored * s.stored * s.stored, 0.0, 3.0 * p[0] * s.stored * s.stored};
    };
    cubic.what.steps_per_sample = 8;
    model.additions.push_back(cubic);
    const Eigen::VectorXd mass = mass_values();
    const Eigen::VectorXd linear = simulate(JointModel{base, {}}, mass, {}, drive(JointModel{base, {}}, mass, u)).value().output;
    const double peak = linear.cwiseAbs().maxCoeff();
    values.resize(4);
    values << mass, 0.1 * mass[2] / (peak * peak);
    const Eigen::VectorXd y = simulate(model, values, {}, drive(model, values, u)).value().output;
    const double rms_u = std::sqrt(u.squaredNorm() / kPeriod), rms_y = std::sqrt(y.squaredNorm() / kPeriod);
    records::Recording r = recording(u, y, noise(7 * kPeriod, 0.003 * rms_y, 0.0, 2));
    r.input.col(0) += noise(7 * kPeriod, 0.03 * rms_u, 0.0, 3);
    record = periodic_record(r, {}, *base).value();
  }
};

}  // namespace

TEST_CASE("likely input: it errs by no more than input and output together leave open, and residuals stay what they were") {
  const Stiffening bench;
  PeriodicRecord likely = bench.record;
  REQUIRE(take_likely_input(bench.model, bench.values, likely));
  const Eigen::VectorXcd truth = coefficients(bench.u);
  double measured = 0.0, found = 0.0, count = 0.0;
  for (const std::int64_t k : lines()) {
    measured += std::norm(bench.record.input_lines(k, 0) - truth[k]) / bench.record.input_variance(k, 0);
    found += std::norm(likely.input_lines(k, 0) - truth[k]) / likely.input_variance(k, 0);
    CHECK(likely.input_variance(k, 0) < bench.record.input_variance(k, 0));
    ++count;
  }
  // Means of squares of complex normal values have the variance 1 / count.
  CHECK(measured / count == Approx(1.0).margin(4.0 / std::sqrt(count)));
  CHECK(found / count == Approx(1.0).margin(4.0 / std::sqrt(count)));
}

TEST_CASE("likely input: draws of opposite sign are opposite, and the same draw is the same") {
  const Stiffening bench;
  PeriodicRecord up = bench.record, again = bench.record, down = bench.record;
  add_input_noise(7, 1.0, up);
  add_input_noise(7, 1.0, again);
  add_input_noise(7, -1.0, down);
  CHECK(up.input == again.input);
  CHECK((up.input + down.input - 2.0 * bench.record.input).norm() < 1e-12 * up.input.norm());
  CHECK((up.input - bench.record.input).norm() > 1e-3 * up.input.norm());
}
