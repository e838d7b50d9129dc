#pragma once

#include <bodeflow/block.hpp>
#include <memory>
#include <span>

#include "averaging_dft_settings.hpp"
#include "collector.hpp"
#include "response_record.hpp"

namespace bodeflow::spectrum {

/// spectrum.averaging_dft: the frequency response from averaged spectra of whole periods, of one or more experiments.
class AveragingDftBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr In<double> reference{2, "reference"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut levels{1, "levels"};

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
  void check_signals(const Facts& f) const;
  void name_signals(const StreamFacts& facts, const char* port);
  std::span<const double> samples(Io& io, Eigen::Index signal) const;
  [[noreturn]] void refuse_sample(Io& io, Eigen::Index a) const;
  std::size_t copy(Io& io, std::size_t from);
  void end_experiment();
  void send(Io& io, std::uint64_t offset, bool last);
  void require_complete() const;

  AveragingDftSettings settings_;  // as given
  Schedule schedule_;              // with the number of experiments
  Measurement measurement_;
  std::vector<std::int64_t> known_lines_;  // that the excitation states

  int vector_level_ = 1;
  std::unique_ptr<Collector> collector_;
  Eigen::MatrixXd frame_;                   // one period; columns: inputs, outputs, references
  std::int64_t position_ = 0, filled_ = 0;  // samples seen; rows of the frame
  std::int64_t experiment_ = 0;             // that is being taken
  std::int64_t used_ = 0;                   // samples that were averaged
  std::vector<Moments> parts_;              // of the experiments before it
  std::int64_t sent_ = 0;                   // periods in the last record
};

}  // namespace bodeflow::spectrum
