#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <vector>

#include "band.hpp"
#include "local_polynomial_record.hpp"
#include "sample_watch.hpp"

namespace bodeflow::spectrum {

/// spectrum.local_polynomial: the frequency response from one record of any shape, by local polynomials.
class LocalPolynomialBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr In<double> reference{2, "reference"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  LineRange check_length(std::int64_t samples) const;
  const Signals& signals_of_port(std::size_t port) const;
  RecordSpectra spectra(std::int64_t samples) const;
  void look_at(std::size_t port, LocalPolynomialOrigin& from) const;

  LocalPolynomialOrigin origin_;
  std::optional<std::int64_t> half_width_;
  std::vector<double> band_hz_;
  std::int64_t limit_ = 0;

  // Input, output, reference: the samples of each channel.
  std::vector<std::vector<std::vector<double>>> samples_;
  std::vector<std::vector<SampleWatch>> watches_;
};

}  // namespace bodeflow::spectrum
