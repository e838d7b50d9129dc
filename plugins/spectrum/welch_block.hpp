#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "band.hpp"
#include "records.hpp"
#include "sample_watch.hpp"
#include "welch.hpp"

namespace bodeflow::spectrum {

/// spectrum.welch: the frequency response and coherence from averaged spectra of windowed segments.
class WelchBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
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
  void take(Io& io, std::size_t from, Eigen::Index count);
  void send(Io& io, std::uint64_t offset);
  std::string channel(Eigen::Index c) const;

  WelchSettings settings_;
  WelchForm form_ = WelchForm::h1;
  std::vector<double> band_hz_;
  std::int64_t every_ = 0;
  Signals inputs_, outputs_;
  LineRange range_;

  std::optional<Welch> welch_;
  std::vector<SampleWatch> watches_;   // one a channel
  Eigen::MatrixXd frame_;              // the newest segment; columns: inputs, outputs
  Eigen::Index filled_ = 0;            // rows of it
  std::int64_t taken_ = 0;             // samples
  std::int64_t sent_ = 0;              // averages in the last record
  std::vector<std::string> warnings_;  // in it
};

}  // namespace bodeflow::spectrum
