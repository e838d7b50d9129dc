#include "model_table.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace bodeflow::validation {
namespace {

using Complex = std::complex<double>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A parameter as all models may share it: coefficients of other methods may have the same names and mean something else.
struct Shared {
  std::string method;  ///< "" for physical parameters
  std::string name, unit;

  bool operator==(const Shared&) const = default;
};

Shared parameter_of(const records::ModelData& m, std::size_t i) {
  return {m.form == "physical" ? "" : m.method, m.parameter_names[i], m.parameter_units[i]};
}

/// Where a model has the parameter, or -1.
Eigen::Index place(const records::ModelData& m, const Shared& parameter) {
  for (std::size_t i = 0; i < m.parameter_names.size(); ++i)
    if (parameter_of(m, i) == parameter) return static_cast<Eigen::Index>(i);
  return -1;
}

bool certain(const records::ModelData& m) { return m.covariance.size() > 0; }

/// Chi-squared of all parameters that both have.
double joint_probability(const records::ModelData& a, const records::ModelData& b) {
  if (!certain(a) || !certain(b)) return kNaN;
  std::vector<Eigen::Index> in_a, in_b;
  for (std::size_t i = 0; i < a.parameter_names.size(); ++i) {
    const Eigen::Index other = place(b, parameter_of(a, i));
    if (other < 0) continue;
    in_a.push_back(static_cast<Eigen::Index>(i));
    in_b.push_back(other);
  }
  if (in_a.empty()) return kNaN;
  const Eigen::VectorXd d = b.parameters(in_b) - a.parameters(in_a);
  const Eigen::MatrixXd c = a.covariance(in_a, in_a) + b.covariance(in_b, in_b);
  // Parameters of sizes far apart: scaled, so that the factorisation keeps its digits.
  const Eigen::VectorXd scale = c.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0.0)) return kNaN;
  const Eigen::VectorXd z = d.cwiseQuotient(scale);
  const Eigen::LDLT<Eigen::MatrixXd> factors(scale.cwiseInverse().asDiagonal() * c * scale.cwiseInverse().asDiagonal());
  if (factors.info() != Eigen::Success || !factors.isPositive() || factors.rcond() < 1e-12) return kNaN;
  return numerics::chi_squared_tail(z.dot(factors.solve(z)), static_cast<double>(z.size()));
}

}  // namespace

ParameterTable parameter_table(const std::vector<std::string>& names, const std::vector<records::ModelData>& models) {
  ParameterTable t;
  std::vector<Shared> all;
  std::vector<std::string> owner;  // the first model that has it
  for (std::size_t m = 0; m < models.size(); ++m)
    for (std::size_t i = 0; i < models[m].parameter_names.size(); ++i) {
      const Shared p = parameter_of(models[m], i);
      if (std::find(all.begin(), all.end(), p) != all.end()) continue;
      all.push_back(p);
      owner.push_back(names[m]);
    }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto alike = [&](const Shared& other) { return other.name == all[k].name; };
    const bool ambiguous = std::count_if(all.begin(), all.end(), alike) > 1;
    t.names.push_back(ambiguous ? all[k].name + " of " + owner[k] : all[k].name);
    t.units.push_back(all[k].unit);
  }
  const auto rows = static_cast<Eigen::Index>(models.size()), columns = static_cast<Eigen::Index>(all.size());
  t.values = t.deviations = t.difference = Eigen::MatrixXd::Constant(rows, columns, kNaN);
  t.probability = Eigen::VectorXd::Constant(rows, kNaN);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const auto& m = models[static_cast<std::size_t>(r)];
    for (Eigen::Index c = 0; c < columns; ++c) {
      const Eigen::Index at = place(m, all[static_cast<std::size_t>(c)]);
      if (at < 0) continue;
      t.values(r, c) = m.parameters[at];
      if (certain(m)) t.deviations(r, c) = std::sqrt(m.covariance(at, at));
      if (r > 0) t.difference(r, c) = (t.values(r, c) - t.values(0, c)) / std::hypot(t.deviations(r, c), t.deviations(0, c));
    }
    if (r > 0) t.probability[r] = joint_probability(models.front(), m);
  }
  return t;
}

Expected<Eigen::VectorXcd> poles_rad_s(const records::ModelData& m) {
  Eigen::VectorXcd all = m.poles;
  if (all.size() == 0) {
    auto roots = numerics::roots(m.denominator);
    if (!roots) return unexpected(roots.error().text);
    all = std::move(*roots);
  }
  std::vector<Complex> poles;
  for (Complex p : all) {
    if (m.sample_time_s > 0.0) {
      if (p == 0.0) continue;  // a delay, at no frequency
      p = std::log(p) / m.sample_time_s;
    }
    if (p.imag() >= 0.0) poles.push_back(p);
  }
  std::sort(poles.begin(), poles.end(), [](Complex a, Complex b) { return std::abs(a) < std::abs(b); });
  return Eigen::VectorXcd(Eigen::Map<Eigen::VectorXcd>(poles.data(), static_cast<Eigen::Index>(poles.size())));
}

Eigen::VectorXd common_grid(const std::vector<records::ModelData>& models, Eigen::Index count) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0, nyquist = low;
  for (const auto& m : models) {
    if (m.sample_time_s > 0.0) nyquist = std::min(nyquist, 0.5 / m.sample_time_s);
    if (m.band_hz && (*m.band_hz)[1] > 0.0) {
      low = std::min(low, (*m.band_hz)[0] > 0.0 ? (*m.band_hz)[0] : (*m.band_hz)[1] / 1000.0);
      high = std::max(high, (*m.band_hz)[1]);
      continue;
    }
    const auto poles = poles_rad_s(m);
    for (Eigen::Index i = 0; poles && i < poles->size(); ++i) {
      const double f = std::abs((*poles)[i]) / (2.0 * std::numbers::pi);
      if (!(f > 0.0)) continue;
      low = std::min(low, f / 10.0);
      high = std::max(high, f * 10.0);
    }
  }
  high = std::min(high, nyquist);
  if (!(high > low) || !(low > 0.0)) return {};
  return Eigen::VectorXd::LinSpaced(count, std::log(low), std::log(high)).array().exp();
}

}  // namespace bodeflow::validation
