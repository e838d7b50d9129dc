#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "averaging_dft.hpp"
#include "response_record.hpp"

namespace bodeflow::spectrum {

/// spectrum.averaging_dft: the frequency response from one input to several outputs, from averaged spectra of whole periods.
class AveragingDftBlock final : public Block {
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
  void configure_lines(const Parameters& p);
  void name_signals(const StreamFacts& facts, const char* port);
  void copy(Io& io, std::size_t from, Eigen::Index count);
  void check_finite(Eigen::Index channel, Eigen::Index from, Eigen::Index count) const;
  void send(Io& io, std::uint64_t offset);

  std::int64_t period_ = 0;
  std::int64_t skip_ = 0;
  std::int64_t every_ = 0;
  LineChoice choice_;
  Measurement measurement_;

  std::optional<AveragingDft> average_;
  Eigen::MatrixXd frame_;    // one period; columns: input, outputs
  Eigen::Index filled_ = 0;  // rows of it
  std::int64_t whole_ = 0;   // whole periods seen, the skipped ones too
  std::int64_t sent_ = 0;    // periods in the last record
};

}  // namespace bodeflow::spectrum
