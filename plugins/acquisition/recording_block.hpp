#pragma once

#include <bodeflow/block.hpp>
#include <vector>

#include "records/recording.hpp"

namespace bodeflow::acquisition {

/// The samples of an experiment as one record.
class RecordingBlock final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void take_excitation(const StreamFacts& u);

  records::Recording about_;  // all but the samples
  std::int64_t limit_ = 0;
  std::vector<std::vector<double>> samples_;  // a channel each, inputs first
};

}  // namespace bodeflow::acquisition
