#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "sine_dwell.hpp"
#include "stepped_sine_record.hpp"

namespace bodeflow::spectrum {

/// spectrum.stepped_sine: the frequency response from one input to several outputs, one frequency after the other.
class SteppedSineBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr MessageIn started{0, "started"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut step{1, "step"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  /// Mean and scatter of the samples before the first frequency.
  struct Silence {
    double mean = 0.0, squares = 0.0;
  };

  void read_sample(Io& io, std::size_t n);
  void hear_silence();
  void settle_noise();
  void begin(const RecordView& record);
  bool is_over() const;
  void conclude(Io& io, std::uint64_t offset);

  SettlingRule rule_;
  std::int64_t windows_ = 0;
  double settled_time_s_ = 0.0;
  double max_time_s_ = 0.0;  // 0: none
  bool advance_ = true;
  bool each_ = false;
  bool noise_given_ = false;
  SteppedMeasurement measurement_;

  std::vector<double> sample_;    // of each signal, the newest
  std::vector<Silence> silence_;  // of each output
  std::int64_t position_ = 0;     // samples so far
  bool begun_ = false;
  std::int64_t index_ = 0;          // of the frequency that is on
  SteppedLine line_;                // of the same
  std::optional<SineDwell> dwell_;  // nothing between two frequencies
  std::vector<SteppedLine> lines_;
};

}  // namespace bodeflow::spectrum
