#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <string>

#include "motor_model.hpp"
#include "records/model.hpp"

namespace bodeflow::frisch {

/// frisch.known_motor: the model of a motor whose resistances and inductances are known, and how far an estimate lies from it.
class KnownMotor final : public Block {
 public:
  static constexpr MessageIn estimate{0, "estimate"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut deviation{1, "deviation"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  RecordBuilder compared() const;

  MotorModel motor_;
  std::optional<records::ModelData> estimate_;  // the last one that arrived
};

}  // namespace bodeflow::frisch
