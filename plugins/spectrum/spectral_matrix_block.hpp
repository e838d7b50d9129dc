#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "averaging_dft.hpp"
#include "spectral_matrix.hpp"

namespace bodeflow::spectrum {

/// spectrum.spectral_matrix: the mean of Z Z^H over windows, and the noise covariance between whole periods.
class SpectralMatrixBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  /// Windows of the stream, `shift` samples apart.
  struct Windows {
    Eigen::MatrixXd frame;
    std::int64_t waiting = 0, filled = 0;
  };
  std::span<const double> samples(Io& io, Eigen::Index signal) const;
  template <class Take>
  void cut(Io& io, Windows& windows, std::int64_t shift, Take take);
  void check_finite(Io& io) const;
  std::vector<std::int64_t> lines() const;
  RecordBuilder record() const;

  std::int64_t period_ = 0, shift_ = 0, skip_ = 0;
  LineChoice choice_;
  Rate rate_;
  Eigen::Index inputs_ = 0;
  std::vector<std::string> names_, units_;

  std::optional<SpectralMatrix> matrix_;
  std::optional<AveragingDft> periods_;  // whole periods: mean and noise covariance
  Windows shifted_, whole_;
  std::int64_t position_ = 0;
};

}  // namespace bodeflow::spectrum
