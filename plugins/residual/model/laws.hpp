#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/joint_model.hpp"

namespace bodeflow::residual {

/// The laws of a model at the places where there are any, with the values of their parameters.
class Laws {
 public:
  Laws(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known);

  /// Places with a law, in the order of the base model's places.
  std::size_t count() const { return places_.size(); }
  std::size_t place(std::size_t i) const { return places_[i].place; }
  /// The law of that place jumps or has corners.
  bool rough(std::size_t i) const { return places_[i].rough; }
  bool keeps_memory() const { return memory_ > 0; }
  bool any_rough() const;
  std::size_t memory() const { return memory_; }

  /// The sum of the reactions at active place i.
  Reaction react(std::size_t i, const Signals& signals, const double* memory, double* next) const {
    const Active& active = places_[i];
    if (active.alone != nullptr) return active.alone->react(active.alone_values, signals, memory, next);
    Reaction sum;
    if (active.of_base) sum = base_->react(values_, known_, active.place, signals);
    for (const Bound& law : active.laws) {
      const Reaction one = law.effect->react(law.values, signals, memory + law.memory, next + law.memory);
      sum.value += one.value;
      sum.by_flow += one.by_flow;
      sum.by_stored += one.by_stored;
    }
    return sum;
  }

 private:
  struct Bound {
    const Effect* effect = nullptr;
    const double* values = nullptr;
    std::size_t memory = 0;  ///< where its part of the memory begins
  };
  struct Active {
    std::size_t place = 0;
    bool of_base = false, rough = false;
    std::vector<Bound> laws;
    const Effect* alone = nullptr;  ///< the only law of the place, its memory at the begin
    const double* alone_values = nullptr;
  };

  const BaseModel* base_;
  const double *values_, *known_;
  std::vector<Active> places_;
  std::size_t memory_ = 0;
};

}  // namespace bodeflow::residual
