#include "model/laws.hpp"

#include <algorithm>

namespace bodeflow::residual {

Laws::Laws(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known)
    : base_(model.base.get()), values_(values.data()), known_(known.data()) {
  const std::size_t places = base_->places().size();
  for (std::size_t p = 0; p < places; ++p) {
    Active active;
    active.place = p;
    active.of_base = base_->has_laws();
    for (std::size_t a = 0; a < model.additions.size(); ++a) {
      const Addition& addition = model.additions[a];
      if (addition.what.acts != Acts::law || addition.place != p) continue;
      active.laws.push_back({addition.effect.get(), model.values_of(a, values), memory_});
      active.rough = active.rough || addition.what.rough;
      memory_ += addition.what.memory;
    }
    if (!active.of_base && active.laws.size() == 1 && active.laws.front().memory == 0) {
      active.alone = active.laws.front().effect;
      active.alone_values = active.laws.front().values;
    }
    if (active.of_base || !active.laws.empty()) places_.push_back(std::move(active));
  }
}

bool Laws::any_rough() const {
  return std::any_of(places_.begin(), places_.end(), [](const Active& a) { return a.rough; });
}

}  // namespace bodeflow::residual
