#include <unsupported/Eigen/FFT>
#include <vector>

#include "bodeflow/numerics/fft.hpp"

namespace bodeflow::numerics {
namespace {

// Eigen's real transform wants an even length: the complex one serves every length alike.
struct KissPlan {
  explicit KissPlan(Eigen::Index n) : x(static_cast<std::size_t>(n)), spectrum(static_cast<std::size_t>(n)) {
    run_forward();  // Eigen makes its twiddle factors at the first call
    run_inverse();
  }

  Eigen::Index length() const { return static_cast<Eigen::Index>(x.size()); }
  // One sample is its own spectrum; Eigen reads past its factors there.
  void run_forward() {
    if (length() == 1) {
      spectrum[0] = x[0];
    } else {
      fft.fwd(spectrum.data(), x.data(), length());
    }
  }
  void run_inverse() {
    if (length() == 1) {
      x[0] = spectrum[0];
    } else {
      fft.inv(x.data(), spectrum.data(), length());
    }
  }

  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> x;
  std::vector<std::complex<double>> spectrum;
};

Eigen::Map<Eigen::VectorXcd> map(std::vector<std::complex<double>>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

}  // namespace

struct RealDft::Plan : KissPlan {
  explicit Plan(Eigen::Index n) : KissPlan(n), samples(n) {}

  Eigen::VectorXd samples;
};

struct ComplexDft::Plan : KissPlan {
  using KissPlan::KissPlan;
};

RealDft::RealDft(Eigen::Index length) : plan_(std::make_unique<Plan>(length)) {}
RealDft::~RealDft() = default;
RealDft::RealDft(RealDft&&) noexcept = default;
RealDft& RealDft::operator=(RealDft&&) noexcept = default;

Eigen::Index RealDft::length() const { return plan_->length(); }

void RealDft::forward(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXcd> spectrum) {
  map(plan_->x) = x.cast<std::complex<double>>();
  plan_->run_forward();
  spectrum = map(plan_->spectrum).head(lines());
}

Eigen::Map<Eigen::VectorXd> RealDft::samples() { return {plan_->samples.data(), length()}; }

Eigen::Map<Eigen::VectorXcd> RealDft::transform() {
  map(plan_->x) = plan_->samples.cast<std::complex<double>>();
  plan_->run_forward();
  return {plan_->spectrum.data(), lines()};
}

ComplexDft::ComplexDft(Eigen::Index length) : plan_(std::make_unique<Plan>(length)) {}
ComplexDft::~ComplexDft() = default;
ComplexDft::ComplexDft(ComplexDft&&) noexcept = default;
ComplexDft& ComplexDft::operator=(ComplexDft&&) noexcept = default;

Eigen::Index ComplexDft::length() const { return plan_->length(); }

void ComplexDft::forward(const Eigen::Ref<const Eigen::VectorXcd>& x, Eigen::Ref<Eigen::VectorXcd> spectrum) {
  map(plan_->x) = x;
  plan_->run_forward();
  spectrum = map(plan_->spectrum);
}

void ComplexDft::inverse(const Eigen::Ref<const Eigen::VectorXcd>& spectrum, Eigen::Ref<Eigen::VectorXcd> x) {
  map(plan_->spectrum) = spectrum;
  plan_->run_inverse();
  x = map(plan_->x);
}

const char* fft_library() { return "kissfft"; }

}  // namespace bodeflow::numerics
