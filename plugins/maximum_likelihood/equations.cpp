#include "equations.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

constexpr double kOnPole = 1e-12;  // relative distance at which a line counts as lying on a fixed pole

Eigen::VectorXcd fixed_factor(const Lines& lines, const Structure& structure) {
  Eigen::VectorXcd factor = Eigen::VectorXcd::Ones(lines.size());
  for (const Complex pole : structure.fixed_poles) factor.array() *= lines.points.array() - pole / lines.scale;
  return factor;
}

// The values and derivatives at one line and output.
struct Equation {
  Complex error;        // A Y - D B U
  double spread = 0.0;  // its variance
  Complex cross;        // d spread / dA conjugated and halved: conj(A) var Y - conj(D B) cov
  Complex cross_of_b;   // the same for D B: conj(D B) var U - conj(A) conj(cov)
};

Equation equation_at(const Channel& c, Eigen::Index k, Complex a, Complex db) {
  Equation e;
  e.error = a * c.output[k] - db * c.input[k];
  e.spread = std::norm(a) * c.output_variance[k] + std::norm(db) * c.input_variance[k] -
             2.0 * std::real(std::conj(db) * a * c.covariance[k]);
  e.cross = std::conj(a) * c.output_variance[k] - std::conj(db) * c.covariance[k];
  e.cross_of_b = std::conj(db) * c.input_variance[k] - std::conj(a * c.covariance[k]);
  return e;
}

}  // namespace

Complex point_at(double omega_rad_s, Domain domain, double sample_time_s, double scale) {
  return domain == Domain::s ? Complex(0.0, omega_rad_s / scale) : std::polar(1.0, omega_rad_s * sample_time_s);
}

Expected<Lines> lines_for(const Spectra& s, const Structure& structure) {
  Lines l;
  l.omega_rad_s = s.omega_rad_s;
  const double highest = s.omega_rad_s[s.lines() - 1];
  l.scale = structure.domain == Domain::s && highest > 0.0 ? highest : 1.0;
  l.weight.resize(s.lines());
  l.points.resize(s.lines());
  for (Eigen::Index k = 0; k < s.lines(); ++k) {
    l.weight[k] = s.weight(k);
    l.points[k] = point_at(s.omega_rad_s[k], structure.domain, s.sample_time_s, l.scale);
  }
  const Eigen::VectorXcd factor = fixed_factor(l, structure);
  for (Eigen::Index k = 0; k < s.lines(); ++k) {
    if (std::abs(factor[k]) > kOnPole) continue;
    return refused("the line at " + std::to_string(s.omega_rad_s[k] / (2.0 * std::numbers::pi)) +
                   " Hz lies on a fixed pole; leave it out by `band`");
  }
  const Eigen::VectorXd squares = factor.cwiseAbs2();
  for (Eigen::Index i = 0; i < s.outputs(); ++i) {
    l.channels.push_back({s.input, factor.cwiseProduct(s.output.col(i)), s.input_variance,
                          squares.cwiseProduct(s.output_variance.col(i)), factor.cwiseProduct(s.covariance.col(i))});
  }
  return l;
}

Eigen::Index Bases::size() const { return offset(numerators.size()); }

Eigen::Index Bases::offset(std::size_t output) const {
  Eigen::Index at = denominator.size();
  for (std::size_t i = 0; i < output; ++i) at += numerators[i].size();
  return at;
}

Eigen::VectorXcd Estimate::numerator(std::size_t output) const {
  const Basis& basis = bases.numerators[output];
  return basis.values() * theta.segment(bases.offset(output), basis.size());
}

Expected<Bases> bases_for(const Lines& lines, const Structure& structure, const Eigen::MatrixXd& deviation) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(lines.size());
  std::vector<Basis> numerators;
  const Eigen::ArrayXd root = lines.weight.array().sqrt();
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Eigen::ArrayXd by = root / deviation.col(static_cast<Eigen::Index>(i)).array();
    squares.array() += (lines.channels[i].output.array().abs() * by).square();
    auto numerator = Basis::orthonormal(lines.points, lines.channels[i].input.array().abs() * by, structure.numerator_orders[i]);
    if (!numerator) return refusal_in(numerator);
    numerators.push_back(std::move(*numerator));
  }
  auto denominator = Basis::orthonormal(lines.points, squares.cwiseSqrt(), structure.free_poles());
  if (!denominator) return refusal_in(denominator);
  return Bases{std::move(*denominator), std::move(numerators)};
}

Eigen::VectorXcd delay_factor(const Lines& lines, double delay_s) {
  return lines.omega_rad_s.unaryExpr([delay_s](double omega) { return std::polar(1.0, -omega * delay_s); });
}

Eigen::MatrixXd spread(const Lines& lines, const Estimate& estimate) {
  const Eigen::VectorXcd a = estimate.denominator(), delay = delay_factor(lines, estimate.delay_s);
  Eigen::MatrixXd s(lines.size(), static_cast<Eigen::Index>(lines.channels.size()));
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Eigen::VectorXcd db = delay.cwiseProduct(estimate.numerator(i));
    for (Eigen::Index k = 0; k < lines.size(); ++k)
      s(k, static_cast<Eigen::Index>(i)) = equation_at(lines.channels[i], k, a[k], db[k]).spread;
  }
  return s;
}

Eigen::MatrixXcd residuals(const Lines& lines, const Estimate& estimate) {
  const Eigen::VectorXcd a = estimate.denominator(), delay = delay_factor(lines, estimate.delay_s);
  Eigen::MatrixXcd r(lines.size(), static_cast<Eigen::Index>(lines.channels.size()));
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Eigen::VectorXcd db = delay.cwiseProduct(estimate.numerator(i));
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      const Equation e = equation_at(lines.channels[i], k, a[k], db[k]);
      r(k, static_cast<Eigen::Index>(i)) = e.error * std::sqrt(lines.weight[k] / e.spread);
    }
  }
  return r;
}

Eigen::MatrixXcd error_directions(const Lines& lines, const Structure& structure, const Estimate& estimate) {
  const Eigen::VectorXcd a = estimate.denominator().cwiseProduct(fixed_factor(lines, structure));
  Eigen::MatrixXcd d(lines.size(), static_cast<Eigen::Index>(lines.channels.size()));
  for (std::size_t i = 0; i < lines.channels.size(); ++i)
    d.col(static_cast<Eigen::Index>(i)) = a.cwiseProduct(lines.channels[i].input);
  return d.unaryExpr([](Complex x) { return x == 0.0 ? Complex(1.0) : x / std::abs(x); });
}

Eigen::MatrixXcd jacobian(const Lines& lines, const Estimate& estimate) {
  const Bases& bases = estimate.bases;
  const Eigen::Index size = lines.size(), poles = bases.denominator.size();
  const Eigen::VectorXcd a = estimate.denominator(), delay = delay_factor(lines, estimate.delay_s);
  Eigen::MatrixXcd j = Eigen::MatrixXcd::Zero(size * static_cast<Eigen::Index>(lines.channels.size()), bases.size() + 1);
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Channel& c = lines.channels[i];
    const Basis& numerator = bases.numerators[i];
    const Eigen::VectorXcd db = delay.cwiseProduct(estimate.numerator(i));
    for (Eigen::Index k = 0; k < size; ++k) {
      const Equation e = equation_at(c, k, a[k], db[k]);
      const double by = std::sqrt(lines.weight[k] / e.spread);
      const Complex shrink = e.error / e.spread;  // d(N s^-1/2) = s^-1/2 (dN - N/(2 s) ds), ds = 2 Re(cross dx)
      auto row = j.row(static_cast<Eigen::Index>(i) * size + k);
      const auto slope = [&](Complex direction, Complex data, Complex cross) {
        return by * (data * direction - shrink * std::real(cross * direction));
      };
      for (Eigen::Index m = 0; m < poles; ++m) row[m] = slope(bases.denominator.values()(k, m), c.output[k], e.cross);
      for (Eigen::Index m = 0; m < numerator.size(); ++m)
        row[bases.offset(i) + m] = slope(delay[k] * numerator.values()(k, m), -c.input[k], e.cross_of_b);
      row[bases.size()] = slope(Complex(0.0, -lines.omega_rad_s[k]) * db[k], -c.input[k], e.cross_of_b);
    }
  }
  return j;
}

Eigen::MatrixXcd information_root(const Lines& lines, const Estimate& estimate) {
  Lines clean = lines;
  const Eigen::VectorXcd a = estimate.denominator(), delay = delay_factor(lines, estimate.delay_s);
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Eigen::VectorXcd db = delay.cwiseProduct(estimate.numerator(i));
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      // E(dU conj(dN)) / spread * N is the part of dU that the error tells; U less it, and Y = G U.
      const Equation e = equation_at(lines.channels[i], k, a[k], db[k]);
      const Complex noise_of_input = -e.cross_of_b / e.spread * e.error;
      clean.channels[i].input[k] -= noise_of_input;
      clean.channels[i].output[k] = db[k] / a[k] * clean.channels[i].input[k];
    }
  }
  return jacobian(clean, estimate);
}

double cost(const Lines& lines, const Estimate& estimate) { return residuals(lines, estimate).squaredNorm(); }

Eigen::MatrixXd stacked(const Eigen::MatrixXcd& m) {
  Eigen::MatrixXd s(2 * m.rows(), m.cols());
  s << m.real(), m.imag();
  return s;
}

}  // namespace bodeflow::maximum_likelihood
