#include <fftw3.h>

#include <cstddef>
#include <new>

#include "bodeflow/numerics/fft.hpp"

namespace bodeflow::numerics {
namespace {

// FFTW has one planner for the whole process, shared by all plugins: its own lock is the only one that they have in common.
void make_planner_safe() {
  static const bool once = (fftw_make_planner_thread_safe(), true);
  static_cast<void>(once);
}

// Buffers of FFTW's own, so that alignment, and with it the code that runs, never depends on the caller.
struct Buffer {
  explicit Buffer(Eigen::Index count) : data(fftw_alloc_complex(static_cast<std::size_t>(count))) {
    if (data == nullptr) throw std::bad_alloc();
  }
  ~Buffer() { fftw_free(data); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  Eigen::Map<Eigen::VectorXcd> complex(Eigen::Index n) const { return {reinterpret_cast<std::complex<double>*>(data), n}; }
  Eigen::Map<Eigen::VectorXd> real(Eigen::Index n) const { return {reinterpret_cast<double*>(data), n}; }

  fftw_complex* data;
};

fftw_plan checked(fftw_plan plan) {
  if (plan == nullptr) throw std::bad_alloc();
  return plan;
}

}  // namespace

struct RealDft::Plan {
  explicit Plan(Eigen::Index n) : length(n), x(n / 2 + 1), spectrum(n / 2 + 1) {
    make_planner_safe();
    forward = checked(fftw_plan_dft_r2c_1d(static_cast<int>(n), reinterpret_cast<double*>(x.data), spectrum.data, FFTW_ESTIMATE));
  }
  ~Plan() { fftw_destroy_plan(forward); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  Eigen::Index length;
  Buffer x;
  Buffer spectrum;
  fftw_plan forward;
};

struct ComplexDft::Plan {
  explicit Plan(Eigen::Index n) : length(n), data(n) {
    make_planner_safe();
    forward = checked(fftw_plan_dft_1d(static_cast<int>(n), data.data, data.data, FFTW_FORWARD, FFTW_ESTIMATE));
    inverse = fftw_plan_dft_1d(static_cast<int>(n), data.data, data.data, FFTW_BACKWARD, FFTW_ESTIMATE);
    if (inverse == nullptr) {
      fftw_destroy_plan(forward);
      throw std::bad_alloc();
    }
  }
  ~Plan() {
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  Eigen::Index length;
  Buffer data;
  fftw_plan forward;
  fftw_plan inverse;
};

RealDft::RealDft(Eigen::Index length) : plan_(std::make_unique<Plan>(length)) {}
RealDft::~RealDft() = default;
RealDft::RealDft(RealDft&&) noexcept = default;
RealDft& RealDft::operator=(RealDft&&) noexcept = default;

Eigen::Index RealDft::length() const { return plan_->length; }

void RealDft::forward(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXcd> spectrum) {
  plan_->x.real(plan_->length) = x;
  fftw_execute(plan_->forward);
  spectrum = plan_->spectrum.complex(lines());
}

Eigen::Map<Eigen::VectorXd> RealDft::samples() { return plan_->x.real(plan_->length); }

Eigen::Map<Eigen::VectorXcd> RealDft::transform() {
  fftw_execute(plan_->forward);
  return plan_->spectrum.complex(lines());
}

ComplexDft::ComplexDft(Eigen::Index length) : plan_(std::make_unique<Plan>(length)) {}
ComplexDft::~ComplexDft() = default;
ComplexDft::ComplexDft(ComplexDft&&) noexcept = default;
ComplexDft& ComplexDft::operator=(ComplexDft&&) noexcept = default;

Eigen::Index ComplexDft::length() const { return plan_->length; }

void ComplexDft::forward(const Eigen::Ref<const Eigen::VectorXcd>& x, Eigen::Ref<Eigen::VectorXcd> spectrum) {
  plan_->data.complex(length()) = x;
  fftw_execute(plan_->forward);
  spectrum = plan_->data.complex(length());
}

void ComplexDft::inverse(const Eigen::Ref<const Eigen::VectorXcd>& spectrum, Eigen::Ref<Eigen::VectorXcd> x) {
  plan_->data.complex(length()) = spectrum;
  fftw_execute(plan_->inverse);
  x = plan_->data.complex(length()) / static_cast<double>(length());
}

const char* fft_library() { return "fftw"; }

}  // namespace bodeflow::numerics
