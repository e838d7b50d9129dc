#include "fake_measurement.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/chi_squared.hpp>
#include <bodeflow/numerics/random.hpp>

namespace bodeflow::residual::test {
namespace {

class FakeEffect final : public Effect {
 public:
  explicit FakeEffect(FakeLaw law) : law_(std::move(law)) {}
  std::string refuses(const Situation&) const override { return law_.refusal; }
  std::vector<FitParameter> parameters(const Situation&) const override { return law_.parameters; }
  std::vector<std::vector<double>> starts(const Situation&) const override { return law_.starts; }
  std::string sentence(std::span<const double>, std::span<const double>, const Situation&) const override { return law_.name; }
  std::complex<double> transfer(const double* p, std::complex<double> s) const override {
    return law_.value(p, s.real(), s.imag());
  }

 private:
  FakeLaw law_;
};

class FakeMeasurement final : public Measurement {
 public:
  FakeMeasurement(const FakeRecord& r, Eigen::VectorXd y) : r_(r), y_(std::move(y)) {
    facts_.name = r.name;
    facts_.input_unit = "V";
    facts_.output_unit = r.unit;
    facts_.checksum = r.name + std::to_string(r.seed);
    facts_.sample_rate_hz = r.sample_rate_hz;
    facts_.samples = r.rows;
    facts_.level = r.level;
  }

  const MeasurementFacts& facts() const override { return facts_; }
  bool floor_known() const override { return r_.floor_known; }
  Eigen::Index rows() const override { return r_.rows; }

  Eigen::VectorXd residual(const JointModel& model, const Eigen::VectorXd& values) const override {
    Eigen::VectorXd e = y_;
    for (Eigen::Index n = 0; n < e.size(); ++n) {
      const std::complex<double> s(static_cast<double>(n), r_.level);
      std::complex<double> base;
      model.base->response(values.data(), nullptr, s, &base);
      double predicted = base.real();
      for (std::size_t a = 0; a < model.additions.size(); ++a)
        predicted += model.additions[a].effect->transfer(model.values_of(a, values), s).real();
      e[n] -= predicted;
    }
    return e / r_.noise;
  }

  Eigen::Index eliminated(const JointModel&, const Eigen::VectorXd&) const override { return 0; }

  std::vector<ClassTest> tests(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                               const Eigen::MatrixXd& covariance, bool fitted) const override {
    const Eigen::MatrixXd spread = jacobian * covariance * jacobian.transpose();
    double freedom = static_cast<double>(r_.rows), sum = residual.squaredNorm();
    if (fitted) {
      freedom -= spread.trace();
    } else {
      const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(r_.rows, r_.rows) + spread;
      sum = residual.dot(all.ldlt().solve(residual));
    }
    return {{"excited", std::sqrt(sum / freedom), numerics::chi_squared_tail(sum, freedom)}};
  }

  Gain gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const override {
    Gain g;
    const double rows = static_cast<double>(r_.rows), b = before.squaredNorm(), a = after.squaredNorm();
    g.likelihood = r_.floor_known ? b - a : rows * std::log(b / a);
    if (!r_.floor_known) {
      const Eigen::VectorXd d = before.cwiseAbs2() - after.cwiseAbs2();
      const double std = std::sqrt((d.array() - d.mean()).square().sum());
      g.block_z = std > 0.0 ? d.sum() / std : 0.0;
    }
    g.excess_before = r_.floor_known ? std::max(b - rows, 0.0) : b;
    g.excess_after = r_.floor_known ? std::max(a - rows, 0.0) : a;
    return g;
  }

  HeldOutError error(const Eigen::VectorXd& residual) const override {
    HeldOutError h;
    const double rows = static_cast<double>(r_.rows);
    h.error = r_.noise * std::sqrt(residual.squaredNorm() / rows);
    if (!r_.floor_known) return h;
    h.floor = r_.noise;
    h.highest = r_.noise * std::sqrt(numerics::chi_squared_limit(1e-3, rows) / rows);
    h.lowest = r_.noise * std::sqrt(numerics::chi_squared_limit(1.0 - 1e-4, rows) / rows);
    return h;
  }

  ResidualPicture picture(const Eigen::VectorXd& residual) const override {
    ResidualPicture p;
    p.axis = "time";
    p.at = Eigen::VectorXd::LinSpaced(r_.rows, 0.0, static_cast<double>(r_.rows - 1)) / 100.0;
    p.measured = y_;
    p.residual = r_.noise * residual;
    return p;
  }

  std::vector<MeasuredResponse> response() const override { return {}; }

  void say(const JointModel&, const Eigen::VectorXd&, std::size_t, Situation& s) const override {
    s.duration_s = static_cast<double>(r_.rows) / 100.0;
    s.sample_time_s = 0.01;
    s.output_unit = r_.unit;
  }

 private:
  FakeRecord r_;
  Eigen::VectorXd y_;
  MeasurementFacts facts_;
};

}  // namespace

std::vector<FitParameter> FakeBase::parameters() const { return {positive("a", "A"), real("b", "A", 1.0)}; }

bool FakeBase::response(const double* v, const double*, std::complex<double> s, std::complex<double>* matrix) const {
  matrix[0] = s.imag() * (v[0] * std::sin(0.9 * s.real()) + v[1] * std::cos(0.35 * s.real()));
  return true;
}

CatalogueEntry fake_effect(const FakeLaw& law) {
  CatalogueEntry entry;
  entry.what.id = "residual." + law.name;
  entry.what.acts = Acts::parallel;
  entry.what.equivalents = law.equivalents;
  entry.effect = std::make_shared<FakeEffect>(law);
  return entry;
}

CatalogueEntry one_sided(const std::string& name, std::function<double(double n, double level)> shape) {
  return fake_effect({name,
                      {real(name + "_size", "A", 1.0).between(0.0, 1e9)},
                      {{0.0}},
                      [shape = std::move(shape)](const double* p, double n, double level) { return p[0] * shape(n, level); }});
}

std::shared_ptr<const Measurement> measure(const FakeRecord& r, const std::function<double(double n, double level)>& hidden) {
  numerics::Random random(r.seed);
  Eigen::VectorXd y(r.rows);
  const FakeBase base;
  const double truth[] = {2.0, 1.0};
  for (Eigen::Index n = 0; n < r.rows; ++n) {
    const double at = static_cast<double>(n);
    std::complex<double> out;
    base.response(truth, nullptr, {at, r.level}, &out);
    y[n] = out.real() + (hidden ? hidden(at, r.level) : 0.0) + r.noise * random.normal();
  }
  return std::make_shared<FakeMeasurement>(r, std::move(y));
}

}  // namespace bodeflow::residual::test
