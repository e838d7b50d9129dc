#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/sampled_path.hpp"
#include "model/simulate.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

/// Output and flows by states, and by inputs and reactions.
Eigen::MatrixXd rows_of(const PlantMatrices& p) {
  Eigen::MatrixXd c(1 + p.places(), p.states());
  c << p.C, p.Cf;
  return c;
}

Eigen::MatrixXd columns_of(const PlantMatrices& p) {
  Eigen::MatrixXd b(p.states(), p.inputs() + p.places());
  b << p.B, p.E;
  return b;
}

Eigen::MatrixXd direct_of(const PlantMatrices& p) {
  Eigen::MatrixXd d(1 + p.places(), p.inputs() + p.places());
  d.row(0) << p.D, p.F;
  if (p.places() > 0) d.bottomRows(p.places()) << p.Df, p.Ff;
  return d;
}

}  // namespace

LinearPath::LinearPath(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known)
    : model_(model), values_(values), known_(known) {
  if (model.base->has_state_space()) plant_ = plant_matrices(*model.base, values.data(), known);
  if (plant_) {
    modes_ = modes_of(plant_->A);
    resolvent_ = Resolvent(plant_->A, modes_, columns_of(*plant_), rows_of(*plant_));
    direct_ = direct_of(*plant_);
  }
  for (const Addition& a : model.additions) {
    bare_ = bare_ && a.what.acts != Acts::immittance && a.what.acts != Acts::series && a.what.acts != Acts::parallel;
    const auto place = static_cast<Eigen::Index>(a.place);
    if (a.what.acts == Acts::immittance &&
        std::find(immittance_places_.begin(), immittance_places_.end(), place) == immittance_places_.end())
      immittance_places_.push_back(place);
  }
}

Eigen::Index LinearPath::inputs() const { return static_cast<Eigen::Index>(model_.base->inputs().size()); }

void LinearPath::plant(Complex s, Eigen::MatrixXcd& g) const {
  if (plant_) {
    resolvent_.at(s, g);
    g += direct_;
    return;
  }
  const BaseModel& base = *model_.base;
  const Eigen::Index q = inputs(), m = static_cast<Eigen::Index>(base.places().size());
  Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix(1 + m, q + m);
  if (base.has_state_space() || !base.response(values_.data(), known_.data(), s, matrix.data()))
    matrix.setConstant(std::numeric_limits<double>::quiet_NaN());
  g = matrix;
}

Eigen::VectorXcd LinearPath::immittances(Complex s) const {
  Eigen::VectorXcd z = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(model_.base->places().size()));
  for (std::size_t a = 0; a < model_.additions.size(); ++a) {
    const Addition& addition = model_.additions[a];
    if (addition.what.acts == Acts::immittance)
      z[static_cast<Eigen::Index>(addition.place)] += addition.effect->transfer(model_.values_of(a, values_), s);
  }
  return z;
}

Complex LinearPath::series(Complex s) const {
  Complex factor = 1.0;
  for (std::size_t a = 0; a < model_.additions.size(); ++a) {
    const Addition& addition = model_.additions[a];
    if (addition.what.acts == Acts::series) factor *= addition.effect->transfer(model_.values_of(a, values_), s);
  }
  return factor;
}

Complex LinearPath::parallel(Complex s) const {
  Complex sum = 0.0;
  for (std::size_t a = 0; a < model_.additions.size(); ++a) {
    const Addition& addition = model_.additions[a];
    if (addition.what.acts == Acts::parallel) sum += addition.effect->transfer(model_.values_of(a, values_), s);
  }
  return sum;
}

Eigen::RowVectorXcd LinearPath::undelayed(Complex s, const Eigen::MatrixXcd& g) const {
  const Eigen::Index m = g.rows() - 1, q = g.cols() - m;
  Eigen::RowVectorXcd response = g.row(0).head(q);
  // Reactions w = Z f of flows f = Gfu u + Gfw w.
  if (immittance_places_.size() == 1) {
    const Eigen::Index p = immittance_places_.front();
    const Complex z = immittances(s)[p];
    response += g(0, q + p) * z / (1.0 - z * g(1 + p, q + p)) * g.row(1 + p).head(q);
  } else if (!immittance_places_.empty()) {
    const Eigen::VectorXcd z = immittances(s);
    const Eigen::MatrixXcd loop = Eigen::MatrixXcd::Identity(m, m) - z.asDiagonal() * g.bottomRightCorner(m, m);
    const Eigen::MatrixXcd pushed = z.asDiagonal() * g.bottomLeftCorner(m, q);
    response += g.row(0).tail(m) * loop.partialPivLu().solve(pushed);
  }
  if (model_.has(Acts::parallel)) response[0] += parallel(s);
  return model_.has(Acts::series) ? Eigen::RowVectorXcd(response * series(s)) : response;
}

Eigen::MatrixXcd plant_response(const BaseModel& base, const Eigen::VectorXd& values, std::span<const double> known, Complex s) {
  JointModel alone;
  alone.base = std::shared_ptr<const BaseModel>(std::shared_ptr<const BaseModel>(), &base);
  Eigen::MatrixXcd g;
  LinearPath(alone, values, known).plant(s, g);
  return g;
}

Eigen::RowVectorXcd joint_response(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                                   Complex s) {
  const LinearPath path(model, values, known);
  Eigen::MatrixXcd g;
  path.plant(s, g);
  return path.undelayed(s, g) * std::exp(-s * model.delay_s(values));
}

Eigen::RowVectorXcd sampled_response(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                                     double frequency_hz, double sample_time_s) {
  return SampledPath(model, values, known, sample_time_s).at(frequency_hz);
}

double settling_s(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known) {
  const auto plant = plant_matrices(*model.base, values.data(), known);
  if (!plant) return std::numeric_limits<double>::quiet_NaN();
  if (plant->states() == 0) return 0.0;
  const Eigen::VectorXcd poles = plant->A.eigenvalues();
  const double least = 1e-9 * poles.cwiseAbs().maxCoeff();
  double slowest = 0.0;
  for (const Complex& p : poles) {
    if (!(-p.real() > least)) return std::numeric_limits<double>::infinity();
    slowest = std::max(slowest, -1.0 / p.real());
  }
  return slowest;
}

}  // namespace bodeflow::residual
