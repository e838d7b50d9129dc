#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "frequency_steps.hpp"
#include "phase.hpp"

namespace bodeflow::generators {

/// generators.stepped_sine: one sine after the other, each until a record or its time says so.
class SteppedSine final : public Block {
 public:
  static constexpr MessageIn step{0, "step"};
  static constexpr Out<double> out{0, "out"};
  static constexpr MessageOut started{0, "started"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void reset() override;

 private:
  void configure_steps(const Parameters& p);
  std::string summary() const;
  std::int64_t longest_length() const;
  std::int64_t dwell_samples(const FrequencyStep& frequency) const;
  void begin_next(Io& io, std::uint64_t offset);
  bool ended() const { return index_ >= static_cast<std::int64_t>(steps_.size()); }

  Rate rate_;
  std::string unit_;
  std::vector<FrequencyStep> steps_;
  std::vector<double> amplitudes_;
  bool continuous_ = true;
  std::int64_t silence_ = 0;  // samples before the first frequency
  double dwell_s_ = 0.0;      // 0: until a record says so

  std::int64_t index_ = -1;  // of the frequency that is on; -1: silence
  std::int64_t left_ = 0;    // samples of it; -1: until a record says so
  Phase phase_, phase_step_;
};

}  // namespace bodeflow::generators
