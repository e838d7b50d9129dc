#include "bodeflow/numerics/linear_system.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;

std::string size_text(const Eigen::MatrixXd& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

// Up to two roots that one real section takes: a conjugate pair, two real ones, or a single one.
struct Group {
  Complex first;
  Complex second;
  int count = 0;

  Eigen::VectorXd polynomial() const {
    if (count == 0) return Eigen::VectorXd::Ones(1);
    if (count == 1) return Eigen::Vector2d(1, -first.real());
    return Eigen::Vector3d(1, -(first + second).real(), (first * second).real());
  }
};

std::vector<Group> grouped(const RealRoots& roots) {
  std::vector<Group> groups;
  for (const Complex& x : roots.pairs) groups.push_back({x, std::conj(x), 2});
  std::size_t k = 0;
  for (; k + 1 < roots.real.size(); k += 2) groups.push_back({roots.real[k], roots.real[k + 1], 2});
  if (k < roots.real.size()) groups.push_back({roots.real[k], 0, 1});
  return groups;
}

struct Section {
  Group poles;
  Group zeros;
};

// Two zeros go to the nearest free section of two poles. A single zero goes to the section with a single pole; without one there
// are more poles than zeros, and a free section of two is left.
std::vector<Section> sections_of(const RealRoots& zeros, const RealRoots& poles) {
  std::vector<Section> sections;
  for (const Group& group : grouped(poles)) sections.push_back({group, {}});
  std::stable_sort(sections.begin(), sections.end(),
                   [](const Section& a, const Section& b) { return std::abs(a.poles.first) < std::abs(b.poles.first); });
  for (const Group& group : grouped(zeros)) {
    Section* best = nullptr;
    const auto better = [&](const Section& section) {
      if (best == nullptr) return true;
      if (section.poles.count != best->poles.count) return section.poles.count < best->poles.count;
      return std::abs(section.poles.first - group.first) < std::abs(best->poles.first - group.first);
    };
    for (Section& section : sections) {
      if (section.zeros.count == 0 && section.poles.count >= group.count && better(section)) best = &section;
    }
    best->zeros = group;
  }
  return sections;
}

// Controllable canonical form; both polynomials trimmed, the numerator's degree at most the denominator's.
StateSpace canonical(const Eigen::VectorXd& numerator, const Eigen::VectorXd& denominator, double sample_time) {
  const Eigen::Index order = denominator.size() - 1;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(order + 1);
  b.tail(numerator.size()) = numerator / denominator[0];
  const Eigen::VectorXd a = denominator / denominator[0];
  StateSpace ss;
  ss.A = Eigen::MatrixXd::Zero(order, order);
  ss.B = Eigen::MatrixXd::Zero(order, 1);
  if (order > 0) {
    ss.A.row(0) = -a.tail(order).transpose();
    ss.A.diagonal(-1).setOnes();
    ss.B(0, 0) = 1;
  }
  ss.D = Eigen::MatrixXd::Constant(1, 1, b[0]);
  ss.C = (b.tail(order) - b[0] * a.tail(order)).transpose();
  ss.sample_time = sample_time;
  return ss;
}

tl::unexpected<Error> improper(Eigen::Index above, Eigen::Index below) {
  return refused("the system is improper: degree " + std::to_string(above) + " above degree " + std::to_string(below));
}

}  // namespace

Expected<StateSpace> make_state_space(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C,
                                      const Eigen::MatrixXd& D, double sample_time) {
  StateSpace ss{A, B, C, D, sample_time};
  if (A.size() == 0 && B.size() == 0 && C.size() == 0) {
    if (D.size() == 0) return refused("a system needs A, B and C, or D");
    ss.A.resize(0, 0);
    ss.B.resize(0, D.cols());
    ss.C.resize(D.rows(), 0);
  } else if (D.size() == 0) {
    ss.D = Eigen::MatrixXd::Zero(C.rows(), B.cols());
  }
  if (ss.A.rows() != ss.A.cols()) return refused("A is " + size_text(ss.A) + ", it must be square");
  if (ss.B.rows() != ss.A.rows())
    return refused("B is " + size_text(ss.B) + ", it must have as many rows as A (" + std::to_string(ss.A.rows()) + ")");
  if (ss.C.cols() != ss.A.rows()) {
    return refused("C is " + size_text(ss.C) + ", it must have as many columns as A (" + std::to_string(ss.A.rows()) + ")");
  }
  if (ss.D.rows() != ss.C.rows() || ss.D.cols() != ss.B.cols()) {
    return refused("D is " + size_text(ss.D) + ", it must be " + std::to_string(ss.C.rows()) + " x " +
                   std::to_string(ss.B.cols()));
  }
  if (!ss.A.allFinite() || !ss.B.allFinite() || !ss.C.allFinite() || !ss.D.allFinite()) {
    return refused("an entry of A, B, C or D is not a finite number");
  }
  return ss;
}

Expected<StateSpace> to_state_space(const TransferFunction& system) {
  if (!system.numerator.allFinite() || !system.denominator.allFinite()) return refused("a coefficient is not a finite number");
  const Eigen::VectorXd numerator = trimmed(system.numerator);
  const Eigen::VectorXd denominator = trimmed(system.denominator);
  if (denominator.size() == 0) return refused("the denominator is zero");
  if (numerator.size() > denominator.size()) return improper(numerator.size() - 1, denominator.size() - 1);
  if (denominator.size() <= 3 || numerator.size() == 0) return canonical(numerator, denominator, system.sample_time);
  const auto zpk = to_zero_pole_gain({numerator, denominator, system.sample_time});
  if (!zpk) return tl::make_unexpected(zpk.error());
  return to_state_space(*zpk);
}

Expected<StateSpace> to_state_space(const ZeroPoleGain& system) {
  if (system.zeros.size() > system.poles.size()) return improper(system.zeros.size(), system.poles.size());
  if (!std::isfinite(system.gain)) return refused("the gain is not a finite number");
  const auto zeros = split_roots(system.zeros);
  if (!zeros) return tl::make_unexpected(Error{"zeros: " + zeros.error().text});
  const auto poles = split_roots(system.poles);
  if (!poles) return tl::make_unexpected(Error{"poles: " + poles.error().text});
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  StateSpace ss = canonical(one, one, system.sample_time);
  for (const Section& section : sections_of(*zeros, *poles)) {
    ss = series(ss, canonical(section.zeros.polynomial(), section.poles.polynomial(), system.sample_time));
  }
  ss.C *= system.gain;
  ss.D *= system.gain;
  return ss;
}

Expected<ZeroPoleGain> to_zero_pole_gain(const TransferFunction& system) {
  const Eigen::VectorXd numerator = trimmed(system.numerator);
  const auto poles = roots(system.denominator);
  if (!poles) return tl::make_unexpected(Error{"denominator: " + poles.error().text});
  if (numerator.size() == 0) return ZeroPoleGain{{}, *poles, 0.0, system.sample_time};
  const auto zeros = roots(numerator);
  if (!zeros) return tl::make_unexpected(Error{"numerator: " + zeros.error().text});
  return ZeroPoleGain{*zeros, *poles, numerator[0] / trimmed(system.denominator)[0], system.sample_time};
}

Expected<TransferFunction> to_transfer_function(const ZeroPoleGain& system) {
  const auto numerator = polynomial_from_roots(system.zeros);
  if (!numerator) return tl::make_unexpected(Error{"zeros: " + numerator.error().text});
  const auto denominator = polynomial_from_roots(system.poles);
  if (!denominator) return tl::make_unexpected(Error{"poles: " + denominator.error().text});
  return TransferFunction{system.gain * *numerator, *denominator, system.sample_time};
}

StateSpace series(const StateSpace& first, const StateSpace& second) {
  const Eigen::Index n1 = first.states();
  const Eigen::Index n2 = second.states();
  StateSpace ss;
  ss.A = Eigen::MatrixXd::Zero(n1 + n2, n1 + n2);
  ss.A.topLeftCorner(n1, n1) = first.A;
  ss.A.bottomLeftCorner(n2, n1) = second.B * first.C;
  ss.A.bottomRightCorner(n2, n2) = second.A;
  ss.B.resize(n1 + n2, first.inputs());
  ss.B << first.B, second.B * first.D;
  ss.C.resize(second.outputs(), n1 + n2);
  ss.C << second.D * first.C, second.C;
  ss.D = second.D * first.D;
  ss.sample_time = first.sample_time;
  return ss;
}

}  // namespace bodeflow::numerics
