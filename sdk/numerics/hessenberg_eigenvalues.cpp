#include "bodeflow/numerics/hessenberg_eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace bodeflow::numerics {
namespace {

constexpr int kMostSteps = 60;     // for one eigenvalue
constexpr int kOddShiftEach = 10;  // steps without success, after which a shift out of the ordinary is tried
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct Column3 {
  double p, q, r;
};

/// The part of a matrix from row `first` to row `last` that double steps act on.
class Window {
 public:
  explicit Window(Eigen::MatrixXd H) : H_(std::move(H)) {
    for (Eigen::Index j = 0; j < H_.cols(); ++j) {
      size_ += H_.col(j).head(std::min(j + 2, H_.rows())).cwiseAbs().sum();
      if (j + 2 < H_.rows()) H_.col(j).tail(H_.rows() - j - 2).setZero();
    }
  }

  double at(Eigen::Index i, Eigen::Index j) const { return H_(i, j); }
  void shift(Eigen::Index last, double by) { H_.diagonal().head(last + 1).array() -= by; }

  /// The first row of the block that ends at `last` and has come apart from what is above it.
  Eigen::Index start_of_block(Eigen::Index last) const {
    for (Eigen::Index l = last; l > 0; --l) {
      const double around = std::abs(H_(l - 1, l - 1)) + std::abs(H_(l, l));
      if (std::abs(H_(l, l - 1)) <= kEpsilon * (around > 0.0 ? around : size_)) return l;
    }
    return 0;
  }

  /// One step with the two shifts whose sum is x + y and whose product is x y - w.
  void step(Eigen::Index first, Eigen::Index last, double x, double y, double w) {
    Eigen::Index k = last - 2;
    Column3 c{};
    for (;; --k) {
      c = first_column(k, x, y, w);
      if (k == first) break;
      const double before = std::abs(H_(k, k - 1)) * (std::abs(c.q) + std::abs(c.r));
      if (before <= kEpsilon * std::abs(c.p) * (std::abs(H_(k - 1, k - 1)) + std::abs(H_(k, k)) + std::abs(H_(k + 1, k + 1))))
        break;
    }
    const Eigen::Index from = k;
    for (; k < last; ++k) {
      double scale = 1.0;
      if (k > from) {
        c = {H_(k, k - 1), H_(k + 1, k - 1), k + 2 <= last ? H_(k + 2, k - 1) : 0.0};
        scale = std::abs(c.p) + std::abs(c.q) + std::abs(c.r);
        if (scale == 0.0) continue;
        c = {c.p / scale, c.q / scale, c.r / scale};
      }
      const double length = std::copysign(std::sqrt(c.p * c.p + c.q * c.q + c.r * c.r), c.p);
      if (k > from) {
        H_(k, k - 1) = -length * scale;
        H_(k + 1, k - 1) = 0.0;
        if (k + 2 <= last) H_(k + 2, k - 1) = 0.0;
      } else if (from > first) {
        H_(k, k - 1) = -H_(k, k - 1);
      }
      reflect(first, last, k, {c.p + length, c.q, c.r}, length);
    }
  }

 private:
  Column3 first_column(Eigen::Index k, double x, double y, double w) const {
    const double z = H_(k, k), r = x - z, s = y - z;
    const Column3 c{(r * s - w) / H_(k + 1, k) + H_(k, k + 1), H_(k + 1, k + 1) - z - r - s, H_(k + 2, k + 1)};
    const double scale = std::abs(c.p) + std::abs(c.q) + std::abs(c.r);
    return scale > 0.0 ? Column3{c.p / scale, c.q / scale, c.r / scale} : c;
  }

  /// The reflection of rows and columns k to k + 2 (k + 1 at the end) with the vector v, v.p length = |v|^2 / 2.
  void reflect(Eigen::Index first, Eigen::Index last, Eigen::Index k, Column3 v, double length) {
    const double x = v.p / length, y = v.q / length, z = v.r / length, q = v.q / v.p, r = v.r / v.p;
    const bool three = k + 2 <= last;
    for (Eigen::Index j = k; j <= last; ++j) {
      double* const h = &H_(k, j);
      const double part = h[0] + q * h[1] + (three ? r * h[2] : 0.0);
      h[0] -= part * x;
      h[1] -= part * y;
      if (three) h[2] -= part * z;
    }
    const Eigen::Index rows = std::min(last, k + 3) - first + 1;
    auto a = H_.col(k).segment(first, rows).array(), b = H_.col(k + 1).segment(first, rows).array();
    if (!three) {
      part_ = x * a + y * b;
      a -= part_;
      b -= q * part_;
      return;
    }
    auto c = H_.col(k + 2).segment(first, rows).array();
    part_ = x * a + y * b + z * c;
    a -= part_;
    b -= q * part_;
    c -= r * part_;
  }

  Eigen::MatrixXd H_;
  Eigen::ArrayXd part_;
  double size_ = 0.0;
};

/// Both eigenvalues of the block of two at the end.
void add_pair(const Window& H, Eigen::Index last, double shift, Eigen::VectorXcd& values) {
  const double x = H.at(last, last), y = H.at(last - 1, last - 1), w = H.at(last, last - 1) * H.at(last - 1, last);
  const double half = 0.5 * (y - x), square = half * half + w, root = std::sqrt(std::abs(square));
  if (square < 0.0) {
    values[last - 1] = {x + half + shift, root};
    values[last] = {x + half + shift, -root};
    return;
  }
  const double far = half + std::copysign(root, half);
  values[last - 1] = x + far + shift;
  values[last] = (far != 0.0 ? x - w / far : x) + shift;
}

}  // namespace

Expected<Eigen::VectorXcd> hessenberg_eigenvalues(Eigen::MatrixXd matrix) {
  if (!matrix.allFinite()) return refused("the matrix is not finite");
  Eigen::VectorXcd values(matrix.rows());
  Eigen::Index last = matrix.rows() - 1;
  Window H(std::move(matrix));
  double shift = 0.0;
  for (int steps = 0; last >= 0;) {
    const Eigen::Index first = H.start_of_block(last);
    if (first + 1 >= last) {
      if (first == last)
        values[last] = H.at(last, last) + shift;
      else
        add_pair(H, last, shift, values);
      last = first - 1;
      steps = 0;
      continue;
    }
    if (++steps > kMostSteps) return refused("an eigenvalue was not found in " + std::to_string(kMostSteps) + " steps");
    double x = H.at(last, last), y = H.at(last - 1, last - 1), w = H.at(last, last - 1) * H.at(last - 1, last);
    if (steps % kOddShiftEach == 0) {
      shift += x;
      H.shift(last, x);
      const double s = std::abs(H.at(last, last - 1)) + std::abs(H.at(last - 1, last - 2));
      x = y = 0.75 * s;
      w = -0.4375 * s * s;
    }
    H.step(first, last, x, y, w);
  }
  return values;
}

Expected<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& A) {
  if (!A.allFinite()) return refused("the matrix is not finite");
  if (A.rows() < 3) return hessenberg_eigenvalues(A);
  return hessenberg_eigenvalues(Eigen::HessenbergDecomposition<Eigen::MatrixXd>(A).matrixH());
}

}  // namespace bodeflow::numerics
