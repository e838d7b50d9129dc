#pragma once

#include <array>
#include <bodeflow/block.hpp>
#include <optional>
#include <vector>

#include "classical_tests.hpp"

namespace bodeflow::drive {

/// drive.classical_tests: the motor from a dc, a no-load and a locked-rotor test.
class ClassicalTests final : public Block {
 public:
  static constexpr MessageIn dc{0, "dc"};
  static constexpr MessageIn no_load{1, "no_load"};
  static constexpr MessageIn locked_rotor{2, "locked_rotor"};
  static constexpr MessageOut model{0, "model"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override { tests_ = {}; }

 private:
  std::array<std::optional<PhaseImpedance>, 3> tests_;
  double no_load_current_ = 0.0;  // rms
  std::vector<double> published_;
};

}  // namespace bodeflow::drive
