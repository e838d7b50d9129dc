#include "bodeflow/numerics/products.hpp"

#include <memory>
#include <new>

#include "dense_kernels.hpp"

namespace bodeflow::numerics {
namespace {

constexpr std::align_val_t kAligned{64};

struct Release {
  void operator()(double* p) const { ::operator delete[](p, kAligned); }
};

const int kLevel = kernels::widest_vector_level();

std::size_t size(Eigen::Index n) { return static_cast<std::size_t>(n); }

void add(Eigen::Ref<Eigen::MatrixXd> C, const Eigen::Ref<const Eigen::MatrixXd>& A, bool transposed,
         const Eigen::Ref<const Eigen::MatrixXd>& B, double factor) {
  if (C.size() == 0 || B.rows() == 0) return;
  const std::unique_ptr<double[], Release> workspace(
      new (kAligned) double[kernels::packed_size(size(B.cols()))]);  // NOLINT: aligned, not filled
  kernels::add_product({size(C.rows()), size(C.cols()), size(B.rows()), A.data(), size(A.outerStride()), transposed, B.data(),
                        size(B.outerStride()), C.data(), size(C.outerStride()), factor},
                       workspace.get(), kLevel);
}

}  // namespace

void add_product(Eigen::Ref<Eigen::MatrixXd> C, const Eigen::Ref<const Eigen::MatrixXd>& A,
                 const Eigen::Ref<const Eigen::MatrixXd>& B, double factor) {
  add(C, A, false, B, factor);
}

Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(A.cols(), B.cols());
  add(C, A, true, B, 1.0);
  return C;
}

Eigen::VectorXd transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& x) {
  Eigen::VectorXd y(A.cols());
  kernels::dot_columns(A.data(), size(A.outerStride()), size(A.rows()), size(A.cols()), x.data(), y.data(), kLevel);
  return y;
}

void subtract_product(Eigen::Ref<Eigen::VectorXd> x, const Eigen::Ref<const Eigen::MatrixXd>& A,
                      const Eigen::Ref<const Eigen::VectorXd>& y) {
  kernels::subtract_columns(A.data(), size(A.outerStride()), size(A.rows()), size(A.cols()), y.data(), x.data(), kLevel);
}

void subtract_outer(Eigen::Ref<Eigen::MatrixXd> A, const Eigen::Ref<const Eigen::VectorXd>& x,
                    const Eigen::Ref<const Eigen::VectorXd>& y) {
  kernels::subtract_outer(x.data(), size(x.size()), y.data(), size(y.size()), A.data(), size(A.outerStride()), kLevel);
}

}  // namespace bodeflow::numerics
