#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// residual.remedy: what a bench can do against the effects that a trace named.
class RemedyBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut delay{1, "delay"};
  static constexpr MessageOut dead_time{2, "dead_time"};
  static constexpr MessageOut offset{3, "offset"};
  static constexpr MessageOut friction{4, "friction"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;

 private:
  struct Knob {
    bool there = false;
    double factor = 1.0;
    std::string parameter, unit, place;
  };
  std::vector<Knob> knobs_;  // one for each of kRemedies
};

}  // namespace bodeflow::residual
