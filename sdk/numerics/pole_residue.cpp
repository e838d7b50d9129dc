#include "bodeflow/numerics/pole_residue.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "bodeflow/numerics/frequency_response.hpp"
#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;

// Of eigenvectors, beyond which poles count as not simple: four digits of the residues are left.
constexpr double kWorstCondition = 1e12;

Expected<void> check(const PoleResidue& system) {
  if (system.residues.size() != static_cast<std::size_t>(system.poles.size()))
    return refused(std::to_string(system.residues.size()) + " residues for " + std::to_string(system.poles.size()) + " poles");
  if (!system.poles.allFinite() || !system.D.allFinite()) return refused("a pole or an entry of D is not a finite number");
  for (std::size_t i = 0; i < system.residues.size(); ++i) {
    const Eigen::MatrixXcd& M = system.residues[i];
    if (M.rows() != system.D.rows() || M.cols() != system.D.cols())
      return refused("residue " + std::to_string(i + 1) + " has another size than D");
    if (!M.allFinite()) return refused("residue " + std::to_string(i + 1) + " is not finite");
    if (system.poles[static_cast<Eigen::Index>(i)].imag() < 0.0)
      return refused("pole " + std::to_string(i + 1) + " has a negative imaginary part: of a pair the other one is listed");
  }
  return {};
}

// Real rows [re; im] of the partial fractions and of the constant.
Eigen::MatrixXd fractions(const Eigen::VectorXcd& poles, const Eigen::VectorXcd& x) {
  const Eigen::Index lines = x.size();
  Eigen::Index columns = 1;
  for (const Complex& p : poles) columns += p.imag() > 0.0 ? 2 : 1;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(2 * lines, columns);
  Eigen::Index at = 0;
  for (const Complex& p : poles) {
    for (Eigen::Index k = 0; k < lines; ++k) {
      const Complex f = 1.0 / (x[k] - p);
      if (p.imag() > 0.0) {
        const Complex g = 1.0 / (x[k] - std::conj(p)), sum = f + g, difference = Complex(0, 1) * (f - g);
        F(k, at) = sum.real();
        F(lines + k, at) = sum.imag();
        F(k, at + 1) = difference.real();
        F(lines + k, at + 1) = difference.imag();
      } else {
        F(k, at) = f.real();
        F(lines + k, at) = f.imag();
      }
    }
    at += p.imag() > 0.0 ? 2 : 1;
  }
  F.col(at).head(lines).setOnes();
  return F;
}

Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXcd>& response) {
  const auto lines = static_cast<Eigen::Index>(response.size());
  Eigen::MatrixXd Y(2 * lines, response.front().size());
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Eigen::MatrixXcd& G = response[static_cast<std::size_t>(k)];
    for (Eigen::Index c = 0; c < G.size(); ++c) {
      Y(k, c) = G.data()[c].real();
      Y(lines + k, c) = G.data()[c].imag();
    }
  }
  return Y;
}

PoleResidue unpacked(const Eigen::VectorXcd& poles, const Eigen::MatrixXd& X, Eigen::Index outputs, Eigen::Index inputs) {
  PoleResidue system;
  system.poles = poles;
  Eigen::Index at = 0;
  for (const Complex& p : poles) {
    Eigen::VectorXcd m = X.row(at).transpose().cast<Complex>();
    if (p.imag() > 0.0) m += Complex(0, 1) * X.row(at + 1).transpose().cast<Complex>();
    system.residues.push_back(m.reshaped(outputs, inputs));
    at += p.imag() > 0.0 ? 2 : 1;
  }
  system.D = X.row(at).transpose().reshaped(outputs, inputs);
  return system;
}

struct Modes {
  Eigen::MatrixXd A, T;  // A = T^-1 (given A) T, block diagonal
};

Expected<Modes> modes_of(const StateSpace& system) {
  if (!system.A.allFinite() || !system.B.allFinite() || !system.C.allFinite() || !system.D.allFinite())
    return refused("an entry of A, B, C or D is not a finite number");
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(system.A);
  if (eigen.info() != Eigen::Success) return refused("the eigenvalues of A were not found");
  Modes modes{eigen.pseudoEigenvalueMatrix(), eigen.pseudoEigenvectors()};
  // Columns of a pair are scaled by one number, so that their block stays as it is.
  for (Eigen::Index k = 0; k < system.states(); ++k) {
    const bool pair = k + 1 < system.states() && modes.A(k, k + 1) != 0.0;
    const Eigen::Index width = pair ? 2 : 1;
    const double norm = modes.T.middleCols(k, width).norm();
    if (norm > 0.0) modes.T.middleCols(k, width) *= std::sqrt(static_cast<double>(width)) / norm;
    k += width - 1;
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(modes.T);
  if (!(lu.rcond() * kWorstCondition > 1.0)) return refused("the poles are not simple: the eigenvectors are nearly dependent");
  return modes;
}

}  // namespace

Expected<Eigen::VectorXcd> upper_poles(const Eigen::VectorXcd& all) {
  const auto split = split_roots(all);
  if (!split) return tl::make_unexpected(split.error());
  Eigen::VectorXcd poles(static_cast<Eigen::Index>(split->pairs.size() + split->real.size()));
  Eigen::Index at = 0;
  for (const Complex& p : split->pairs) poles[at++] = p;
  for (const double p : split->real) poles[at++] = p;
  return poles;
}

Eigen::VectorXcd all_poles(const PoleResidue& system) {
  std::vector<Complex> all;
  for (const Complex& p : system.poles) {
    all.push_back(p);
    if (p.imag() > 0.0) all.push_back(std::conj(p));
  }
  return Eigen::Map<const Eigen::VectorXcd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

std::vector<Eigen::MatrixXcd> frequency_response(const PoleResidue& system, const Eigen::VectorXd& frequency_hz) {
  std::vector<Eigen::MatrixXcd> response;
  response.reserve(static_cast<std::size_t>(frequency_hz.size()));
  for (const double f : frequency_hz) {
    const Complex x = frequency_point(f, system.sample_time);
    Eigen::MatrixXcd G = system.D.cast<Complex>();
    for (Eigen::Index i = 0; i < system.poles.size(); ++i) {
      const Complex p = system.poles[i];
      const Eigen::MatrixXcd& M = system.residues[static_cast<std::size_t>(i)];
      G += M / (x - p);
      if (p.imag() > 0.0) G += M.conjugate() / (x - std::conj(p));
    }
    response.push_back(std::move(G));
  }
  return response;
}

Expected<PoleResidue> residues_by_least_squares(const Eigen::VectorXcd& poles, const Eigen::VectorXd& frequency_hz,
                                                const std::vector<Eigen::MatrixXcd>& response, const Eigen::VectorXd& weight,
                                                double sample_time) {
  const Eigen::Index lines = frequency_hz.size();
  if (lines == 0 || response.size() != static_cast<std::size_t>(lines))
    return refused(std::to_string(response.size()) + " responses for " + std::to_string(lines) + " frequencies");
  if (weight.size() != 0 && weight.size() != lines)
    return refused(std::to_string(weight.size()) + " weights for " + std::to_string(lines) + " frequencies");
  const Eigen::Index outputs = response.front().rows(), inputs = response.front().cols();
  for (const Eigen::MatrixXcd& G : response)
    if (G.rows() != outputs || G.cols() != inputs) return refused("the responses have different sizes");
  if (!poles.allFinite() || (poles.size() > 0 && poles.imag().minCoeff() < 0.0))
    return refused("the poles must be finite, without negative imaginary parts");
  const Eigen::VectorXcd x = frequency_hz.unaryExpr([&](double f) { return frequency_point(f, sample_time); });
  Eigen::MatrixXd F = fractions(poles, x), Y = stacked(response);
  if (F.rows() < F.cols())
    return refused(std::to_string(lines) + " lines are too few for residues of " + std::to_string(F.cols() - 1) + " poles");
  if (weight.size() != 0) {
    F = weight.replicate(2, 1).asDiagonal() * F;
    Y = weight.replicate(2, 1).asDiagonal() * Y;
  }
  if (!F.allFinite()) return refused("a pole lies on a line of the response, or a weight is not finite");
  if (!Y.allFinite()) return refused("the response has a value that is not finite");
  const Eigen::VectorXd norm = F.colwise().norm().unaryExpr([](double n) { return n > 0.0 ? n : 1.0; });
  F = F * norm.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd X = norm.cwiseInverse().asDiagonal() * Eigen::MatrixXd(F.colPivHouseholderQr().solve(Y));
  PoleResidue system = unpacked(poles, X, outputs, inputs);
  system.sample_time = sample_time;
  return system;
}

Expected<StateSpace> modal_form(const StateSpace& system) {
  if (system.states() == 0) return system;
  const auto modes = modes_of(system);
  if (!modes) return tl::make_unexpected(modes.error());
  return StateSpace{modes->A, modes->T.partialPivLu().solve(system.B), system.C * modes->T, system.D, system.sample_time};
}

Expected<PoleResidue> to_pole_residue(const StateSpace& system) {
  PoleResidue result{Eigen::VectorXcd(), {}, system.D, system.sample_time};
  const auto modal = modal_form(system);
  if (!modal) return tl::make_unexpected(modal.error());
  std::vector<Complex> poles;
  const Complex j(0, 1);
  for (Eigen::Index k = 0; k < modal->states(); ++k) {
    const Eigen::RowVectorXcd b = modal->B.row(k).cast<Complex>();
    const Eigen::VectorXcd c = modal->C.col(k).cast<Complex>();
    if (k + 1 == modal->states() || modal->A(k, k + 1) == 0.0) {
      poles.emplace_back(modal->A(k, k), 0.0);
      result.residues.emplace_back(c * b);
      continue;
    }
    // The block [re, w; -w, re] has the mode x1 - i x2 with the pole re + i w: C = [c1 c2] sees (c1 + i c2) / 2 of it.
    const double w = modal->A(k, k + 1), sign = w > 0.0 ? 1.0 : -1.0;
    poles.emplace_back(modal->A(k, k), std::abs(w));
    const Eigen::VectorXcd left = 0.5 * (c + sign * j * modal->C.col(k + 1).cast<Complex>());
    const Eigen::RowVectorXcd right = b - sign * j * modal->B.row(k + 1).cast<Complex>();
    result.residues.emplace_back(left * right);
    ++k;
  }
  result.poles = Eigen::Map<const Eigen::VectorXcd>(poles.data(), static_cast<Eigen::Index>(poles.size()));
  return result;
}

Expected<PoleResidue> to_pole_residue(const TransferFunction& system) {
  const auto zpk = to_zero_pole_gain(system);
  if (!zpk) return tl::make_unexpected(zpk.error());
  if (zpk->zeros.size() > zpk->poles.size()) return refused("the system is improper");
  const auto poles = upper_poles(zpk->poles);
  if (!poles) return tl::make_unexpected(poles.error());
  PoleResidue result{*poles, {}, Eigen::MatrixXd::Zero(1, 1), system.sample_time};
  if (zpk->zeros.size() == zpk->poles.size()) result.D(0, 0) = zpk->gain;
  for (const Complex& p : *poles) {
    Complex residue = zpk->gain;
    bool itself = true;
    for (const Complex& z : zpk->zeros) residue *= p - z;
    for (const Complex& other : zpk->poles) {
      if (itself && other == p) {
        itself = false;
      } else {
        residue /= p - other;
      }
    }
    if (p.imag() == 0.0) residue = residue.real();
    if (!std::isfinite(residue.real()) || !std::isfinite(residue.imag())) return refused("the poles are not simple");
    result.residues.push_back(Eigen::MatrixXcd::Constant(1, 1, residue));
  }
  return result;
}

Expected<StateSpace> gilbert_realisation(const PoleResidue& system, double tolerance) {
  if (const auto fine = check(system); !fine) return tl::make_unexpected(fine.error());
  if (!(tolerance >= 0.0 && tolerance < 1.0)) return refused("the tolerance of a rank must be from 0 to below 1");
  const Eigen::Index outputs = system.D.rows(), inputs = system.D.cols();
  std::vector<Eigen::JacobiSVD<Eigen::MatrixXcd>> factors;
  std::vector<Eigen::Index> ranks;
  Eigen::Index states = 0;
  for (Eigen::Index i = 0; i < system.poles.size(); ++i) {
    factors.emplace_back(system.residues[static_cast<std::size_t>(i)], Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXd& s = factors.back().singularValues();
    Eigen::Index rank = 0;
    while (rank < s.size() && s[rank] > tolerance * s[0]) ++rank;
    ranks.push_back(rank);
    states += system.poles[i].imag() > 0.0 ? 2 * rank : rank;
  }
  StateSpace ss{Eigen::MatrixXd::Zero(states, states), Eigen::MatrixXd(states, inputs), Eigen::MatrixXd(outputs, states),
                system.D, system.sample_time};
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const Complex p = system.poles[static_cast<Eigen::Index>(i)];
    for (Eigen::Index r = 0; r < ranks[i]; ++r) {
      const double root = std::sqrt(factors[i].singularValues()[r]);
      Eigen::VectorXcd L = root * factors[i].matrixU().col(r);
      Eigen::RowVectorXcd R = root * factors[i].matrixV().col(r).adjoint();
      if (p.imag() > 0.0) {
        ss.A.block<2, 2>(at, at) << p.real(), -p.imag(), p.imag(), p.real();
        ss.B.row(at) = R.real();
        ss.B.row(at + 1) = R.imag();
        ss.C.col(at) = 2.0 * L.real();
        ss.C.col(at + 1) = -2.0 * L.imag();
        at += 2;
        continue;
      }
      // The factors of a real matrix may carry a common phase.
      Eigen::Index largest = 0;
      L.cwiseAbs().maxCoeff(&largest);
      const Complex phase = L[largest] / std::abs(L[largest]);
      ss.A(at, at) = p.real();
      ss.B.row(at) = (R * phase).real();
      ss.C.col(at) = (L / phase).real();
      ++at;
    }
  }
  return ss;
}

}  // namespace bodeflow::numerics
