#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "model/sampled_path.hpp"
#include "model/simulate.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

/// The entries of these rows and columns.
Eigen::MatrixXd part(const Eigen::MatrixXd& m, const std::vector<Eigen::Index>& rows, const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd p(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c)
      p(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = m(rows[r], columns[c]);
  return p;
}

std::vector<Eigen::Index> counted_up(Eigen::Index count) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Output and flows by states, by inputs and reactions, and states by inputs and reactions.
struct Whole {
  Eigen::MatrixXd c, d, b;
};

Whole whole_of(const PlantMatrices& p) {
  const Eigen::Index n = p.states(), q = p.inputs(), m = p.places();
  Whole w{Eigen::MatrixXd(1 + m, n), Eigen::MatrixXd(1 + m, q + m), Eigen::MatrixXd(n, q + m)};
  w.c << p.C, p.Cf;
  w.b << p.B, p.E;
  w.d.row(0) << p.D, p.F;
  if (m > 0) w.d.bottomRows(m) << p.Df, p.Ff;
  return w;
}

}  // namespace

LinearPath::LinearPath(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known)
    : model_(model), values_(values), known_(known) {
  if (model.base->has_state_space()) plant_ = plant_matrices(*model.base, values.data(), known);
  for (const Addition& a : model.additions) {
    bare_ = bare_ && a.what.acts != Acts::immittance && a.what.acts != Acts::series && a.what.acts != Acts::parallel;
    const auto place = static_cast<Eigen::Index>(a.place);
    if (a.what.acts == Acts::immittance &&
        std::find(immittance_places_.begin(), immittance_places_.end(), place) == immittance_places_.end())
      immittance_places_.push_back(place);
  }
  if (!plant_) return;
  modes_ = modes_of(plant_->A);
  std::vector<Eigen::Index> rows = {0}, columns = counted_up(inputs());
  for (const Eigen::Index p : immittance_places_) {
    rows.push_back(1 + p);
    columns.push_back(inputs() + p);
  }
  const Whole whole = whole_of(*plant_);
  const std::vector<Eigen::Index> states = counted_up(plant_->states());
  resolvent_ = Resolvent(plant_->A, modes_, part(whole.b, states, columns), part(whole.c, rows, states));
  direct_ = part(whole.d, rows, columns);
}

Eigen::Index LinearPath::inputs() const { return static_cast<Eigen::Index>(model_.base->inputs().size()); }

void LinearPath::plant(Complex s, Eigen::MatrixXcd& g) const {
  if (plant_) {
    const Whole whole = whole_of(*plant_);
    Resolvent(plant_->A, modes_, whole.b, whole.c).at(s, g);
    g += whole.d;
    return;
  }
  const BaseModel& base = *model_.base;
  const Eigen::Index q = inputs(), m = static_cast<Eigen::Index>(base.places().size());
  Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix(1 + m, q + m);
  if (base.has_state_space() || !base.response(values_.data(), known_.data(), s, matrix.data()))
    matrix.setConstant(std::numeric_limits<double>::quiet_NaN());
  g = matrix;
}

/// Sets g_ to what `responses` needs of the plant.
void LinearPath::seen(Complex s) const {
  if (plant_) {
    resolvent_.at(s, g_);
    g_ += direct_;
    return;
  }
  Eigen::MatrixXcd all;
  plant(s, all);
  const Eigen::Index q = inputs(), k = static_cast<Eigen::Index>(immittance_places_.size());
  g_.resize(1 + k, q + k);
  for (Eigen::Index r = 0; r <= k; ++r) {
    const Eigen::Index row = r == 0 ? 0 : 1 + immittance_places_[static_cast<std::size_t>(r - 1)];
    for (Eigen::Index c = 0; c < q + k; ++c)
      g_(r, c) = all(row, c < q ? c : q + immittance_places_[static_cast<std::size_t>(c - q)]);
  }
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

void LinearPath::responses(Complex s, Eigen::RowVectorXcd& plain, Eigen::RowVectorXcd& joint) const {
  seen(s);
  const Eigen::Index q = inputs(), k = static_cast<Eigen::Index>(immittance_places_.size());
  plain.resize(q);
  for (Eigen::Index j = 0; j < q; ++j) plain[j] = g_(0, j);
  joint = plain;
  if (bare_) return;
  // Reactions w = Z f of flows f = Gfu u + Gfw w.
  if (k == 1) {
    Complex z = 0.0;
    for (std::size_t a = 0; a < model_.additions.size(); ++a)
      if (model_.additions[a].what.acts == Acts::immittance)
        z += model_.additions[a].effect->transfer(model_.values_of(a, values_), s);
    const Complex factor = g_(0, q) * z / (1.0 - z * g_(1, q));
    for (Eigen::Index j = 0; j < q; ++j) joint[j] += factor * g_(1, j);
  } else if (k > 1) {
    const Eigen::VectorXcd all = immittances(s);
    Eigen::VectorXcd z(k);
    for (Eigen::Index i = 0; i < k; ++i) z[i] = all[immittance_places_[static_cast<std::size_t>(i)]];
    const Eigen::MatrixXcd loop = Eigen::MatrixXcd::Identity(k, k) - z.asDiagonal() * g_.bottomRightCorner(k, k);
    const Eigen::MatrixXcd pushed = z.asDiagonal() * g_.bottomLeftCorner(k, q);
    joint += g_.row(0).tail(k) * loop.partialPivLu().solve(pushed);
  }
  joint[0] += parallel(s);
  joint *= series(s);
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
  Eigen::RowVectorXcd plain, joint;
  LinearPath(model, values, known).responses(s, plain, joint);
  return joint * std::exp(-s * model.delay_s(values));
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
