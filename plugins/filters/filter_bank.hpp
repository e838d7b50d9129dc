#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/narrow_band_pass.hpp>
#include <bodeflow/numerics/second_order_sections.hpp>
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kernels.hpp"

namespace bodeflow::filters {

/// One filter of a bank: sections in direct form, or rotations.
struct BankFilter {
  std::string label;  ///< tells its channel apart, where there are several
  std::variant<numerics::Sections, numerics::NarrowBandPass> filter;

  /// H(exp(j w_h)).
  std::complex<double> response(double w_h) const;
  /// The first `count` samples of the impulse response.
  Eigen::VectorXd impulse_response(std::size_t count) const;
  /// Radius and angle [rad] of the poles, one of each conjugate pair.
  std::vector<std::complex<double>> poles() const;
};

/// Every filter on every channel: output c K + k is filter k of channel c. Eight outputs at a time go through the vector unit;
/// the bits are those of one filter alone (numerics::SectionFilter, NarrowBandPass::step), but that a state below 1e-290 becomes
/// 0 at the end of each 64 samples.
class FilterBank {
 public:
  /// All filters of one form. Allocates all that is needed.
  FilterBank(const std::vector<BankFilter>& filters, std::size_t channels);

  /// x: a pointer for each channel, y: one for each output; y may be x where there is one filter. Returns the channel whose state
  /// is no longer finite, if any, as seen at the ends of tiles of 64 samples.
  std::optional<std::size_t> run(const double* const* x, double* const* y, std::size_t count, int vector_level);

  /// Back to a past of zeros.
  void reset();

  std::size_t outputs() const { return lanes_; }

 private:
  struct Free {
    void operator()(double* memory) const { std::free(memory); }
  };
  using Memory = std::unique_ptr<double[], Free>;
  static Memory zeros(std::size_t count);

  void place(const BankFilter& filter, std::size_t lane);

  std::size_t filters_ = 0;
  std::size_t lanes_ = 0;
  std::size_t sections_ = 0;
  std::size_t coefficients_in_section_ = 0;
  bool rotations_ = false;
  Memory coefficients_, states_;
  std::size_t state_count_ = 0;
  std::vector<const double*> inputs_;
  std::size_t position_ = 0;
};

}  // namespace bodeflow::filters
