#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "bodeflow/numerics/error.hpp"

/// Real polynomials as vectors of coefficients in descending powers: {1, 3, 2} is x^2 + 3 x + 2.
namespace bodeflow::numerics {

/// The polynomial without leading zeros; empty for the zero polynomial.
Eigen::VectorXd trimmed(const Eigen::VectorXd& polynomial);

/// p(x) by Horner's rule; 0 for an empty polynomial.
std::complex<double> evaluate(const Eigen::VectorXd& polynomial, std::complex<double> x);

/// The product a * b; empty where one of them is empty.
Eigen::VectorXd multiply(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// The roots, in conjugate pairs one after the other, sorted by magnitude; empty for a constant.
/// Method: eigenvalues of the balanced companion matrix (Edelman & Murakami, "Polynomial roots from companion matrix
/// eigenvalues", Math. Comp. 64, 1995). They are the exact roots of a polynomial near
/// the given one: a root of multiplicity m is only good to the m-th root of the rounding error. Roots at zero are exact. Cost:
/// O(n^3). Errors: the zero polynomial, a coefficient that is not finite.
Expected<Eigen::VectorXcd> roots(const Eigen::VectorXd& polynomial);

/// Roots of a real polynomial, sorted apart by magnitude: of each conjugate pair the one with positive imaginary part, and the
/// real ones.
struct RealRoots {
  std::vector<std::complex<double>> pairs;
  std::vector<double> real;
};

/// `roots` as conjugate pairs and real roots. An imaginary part below 1e-12 of the magnitude counts as rounding.
/// Errors: a root that is not finite; a complex root whose conjugate is missing (beyond 1e-9 of its magnitude).
Expected<RealRoots> split_roots(const Eigen::VectorXcd& roots);

/// The monic real polynomial with these roots. Errors: those of split_roots.
Expected<Eigen::VectorXd> polynomial_from_roots(const Eigen::VectorXcd& roots);

}  // namespace bodeflow::numerics
