#include <map>

#include "catch.hpp"
#include "periodic/periodic_measurement.hpp"
#include "periodic_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::small;

namespace {

/// The mass with noise of a percent, and a tone of that many times the noise.
struct Hummed {
  std::shared_ptr<Mass> base = std::make_shared<Mass>();
  JointModel model{base, {}};
  Eigen::VectorXd u = multisine(1.0, 1), y;
  double std = 0.0;

  Hummed() {
    base->declared.hold = Hold::zero_order;
    y = simulate(model, mass_values(), {}, drive(model, mass_values(), u)).value().output;
    std = 0.01 * std::sqrt(y.squaredNorm() / kPeriod);
  }
  std::shared_ptr<const Measurement> with(double multiple, double hz) const {
    Eigen::VectorXd e = noise(7 * kPeriod, std, 0.0, 5);
    for (Eigen::Index n = 0; n < e.size(); ++n)
      e[n] += multiple * std * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(n) / kRate + 0.4);
    return periodic_measurement(recording(u, y, e), "x", {}, *base).value();
  }
};

// Bins are kRate / (6 kPeriod) = 0.03255 Hz apart: this one is 0.31 of a bin off one between the lines.
constexpr double kTone = kRate / (6.0 * kPeriod) * 500.31;

}  // namespace

TEST_CASE("tones: the noise floor of a record is the same with a high tone between the lines") {
  const Hummed bench;
  const auto floor = [](const Measurement& m) {
    const ResidualPicture p = m.picture(Eigen::VectorXd::Zero(m.rows()));
    std::map<double, double> at;
    for (Eigen::Index n = 0; n < p.at.size(); ++n) at[p.at[n]] = p.noise[n];
    return at;
  };
  const auto quiet = floor(*bench.with(0.0, kTone)), hummed = floor(*bench.with(20.0, kTone));
  CHECK(hummed.size() > quiet.size());  // all bins are shown, not the lines alone
  for (const auto& [hz, level] : quiet) {
    INFO("at " << hz << " Hz");
    CHECK(hummed.at(hz) == Approx(level).epsilon(0.03));
  }
}

TEST_CASE("tones: the highest peak has a probability however high it is") {
  const Hummed bench;
  const auto m = bench.with(200.0, kTone);
  const Eigen::VectorXd left = m->residual(bench.model, mass_values());
  for (const ClassTest& t : m->tests(left, Eigen::MatrixXd(left.size(), 0), Eigen::MatrixXd(0, 0), false))
    if (t.name == "peak") CHECK(t.p == 0.0);
  CHECK_FALSE(m->error(left).at_floor());
  CHECK_FALSE(m->error(left).leak());
}

TEST_CASE("tones: a tone taken out leaves noise at the lines beside it too") {
  const Hummed bench;
  auto [tone, made_tone] = made(Acts::tone, 1);
  made_tone->tones = [](const double* p) { return std::vector<double>{p[0]}; };
  const JointModel with_tone{bench.base, {tone}};
  Eigen::VectorXd values(4);
  values << mass_values(), kTone;
  const auto quiet = bench.with(0.0, kTone), hummed = bench.with(20.0, kTone);
  const Eigen::VectorXd expected = quiet->residual(with_tone, values), left = hummed->residual(with_tone, values);
  // The floor of both is the same within its own uncertainty, and so are the rows.
  CHECK((left - expected).norm() < 0.05 * expected.norm());
  CHECK(hummed->eliminated(with_tone, values) == 2);
}

TEST_CASE("tones: a drift that a model explains raised the floor of its own record, and is no leak") {
  const Hummed bench;
  auto [drift, grows] = made(Acts::output, 1);
  drift.what.nonstationary = true;
  grows->maps = [](const double* p, double x, double t, double*) { return x * (1.0 + p[0] * t); };
  const JointModel drifting{bench.base, {drift}};
  const double rate = 5e-4;  // a second; a record has 36 of them
  Eigen::VectorXd y = bench.y.replicate(7, 1);
  for (Eigen::Index n = 0; n < y.size(); ++n) y[n] *= 1.0 + rate * static_cast<double>(n) / kRate;
  const auto m = periodic_measurement(recording(bench.u, y, noise(7 * kPeriod, bench.std, 0.0, 5)), "x", {}, *bench.base).value();
  Eigen::VectorXd values(4);
  values << mass_values(), rate;
  const HeldOutError right = m->error(m->residual(drifting, values));
  INFO("error " << right.error << ", floor " << right.floor);
  CHECK_FALSE(right.leak());
  CHECK(right.error < 0.97 * right.floor);
  // Less at the lines alone is one.
  const auto quiet = bench.with(0.0, kTone);
  Eigen::VectorXd fed = quiet->residual(bench.model, mass_values());
  CHECK_FALSE(quiet->error(fed).leak());
  for (Eigen::Index row = 11; row + 1 < fed.size(); row += 12) fed.segment(row, 2) *= 0.5;  // bins 6, 12, ...
  CHECK(quiet->error(fed).leak());
}
