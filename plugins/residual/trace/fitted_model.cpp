#include "trace/fitted_model.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/polynomial.hpp>

namespace bodeflow::residual {
namespace {

constexpr int kMostStates = 12;

/// Numerator and denominator of C (sI - A)^-1 B + D. Method: Faddeev-Leverrier recursion (D. K. Faddeev, V. N. Faddeeva,
/// Computational Methods of Linear Algebra, 1963, section 47).
void set_transfer_function(const LinearPlant& plant, records::ModelData& m) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index n = plant.states;
  const Eigen::MatrixXd A = Eigen::Map<const RowMajor>(plant.A.data(), n, n);
  const Eigen::VectorXd B = Eigen::Map<const Eigen::VectorXd>(plant.B.data(), n);
  const Eigen::RowVectorXd C = Eigen::Map<const Eigen::RowVectorXd>(plant.C.data(), n);
  Eigen::VectorXd denominator(n + 1), numerator = Eigen::VectorXd::Zero(n + 1);
  denominator[0] = 1.0;
  Eigen::MatrixXd adjugate = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index k = 1; k <= n; ++k) {
    numerator[k] = C * adjugate * B;
    const Eigen::MatrixXd product = A * adjugate;
    denominator[k] = -product.trace() / static_cast<double>(k);
    adjugate = product + denominator[k] * Eigen::MatrixXd::Identity(n, n);
  }
  numerator += plant.D[0] * denominator;
  numerator = numerics::trimmed(numerator);
  if (numerator.size() == 0 || !numerator.allFinite() || !denominator.allFinite()) return;
  auto poles = numerics::roots(denominator), zeros = numerics::roots(numerator);
  if (!poles || !zeros) return;
  m.numerator = numerator;
  m.denominator = denominator;
  m.poles = *poles;
  m.zeros = *zeros;
}

}  // namespace

records::ModelData model_of(const Fit& fit, const Measurements& records) {
  records::ModelData m;
  const BaseModel& base = *fit.model.base;
  const Eigen::VectorXd values = fit.values();
  m.method = "residual.trace";
  m.form = "physical";
  for (const FitParameter& p : fit.model.parameters()) {
    m.parameter_names.push_back(p.name);
    m.parameter_units.push_back(p.unit);
  }
  m.parameters = values;
  m.covariance = fit.value_covariance();
  m.conventions = base.conventions();
  m.delay_s = fit.model.delay_s(values);
  const MeasurementFacts& first = records.front()->facts();
  LinearPlant plant;
  const std::vector<double> known = first.known.empty() ? std::vector<double>(base.known().size(), 0.0) : first.known;
  const std::vector<PlantInput> inputs = base.inputs();
  if (inputs.size() == 1 && inputs.front().derivative == 0 && base.state_space(values.data(), known.data(), plant) &&
      plant.states > 0 && plant.states <= kMostStates)
    set_transfer_function(plant, m);
  m.order = plant.states;
  for (const Addition& a : fit.model.additions)
    m.warnings.push_back("numerator and denominator are those of the base model, without " + a.label +
                         "; use the parameters of the effect beside them");
  if (!fit.converged)
    m.warnings.push_back("the fit did not converge: the parameters are not the best ones; check what is declared");
  m.input_name = first.input_name;
  m.output_name = first.output_name;
  m.input_unit = first.input_unit;
  m.output_unit = first.output_unit;
  std::int64_t samples = 0;
  for (const auto& r : records) {
    samples += r->facts().samples;
    m.data_checksum += (m.data_checksum.empty() ? "" : " ") + r->facts().checksum;
  }
  m.cost = fit.chi2 / 2.0;
  m.cost_degrees_of_freedom = static_cast<double>(fit.residual.size() - fit.at.size());
  m.expected_cost = *m.cost_degrees_of_freedom / 2.0;
  if (first.sample_rate_hz > 0.0) m.sample_rate_hz = first.sample_rate_hz;
  m.samples = samples;
  return m;
}

}  // namespace bodeflow::residual
