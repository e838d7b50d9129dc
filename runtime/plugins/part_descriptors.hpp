#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plugins/description.hpp"

namespace bodeflow {

/// The C descriptors of effects and base models, for blocks that list them.
class PartDescriptors {
 public:
  PartDescriptors();
  ~PartDescriptors();
  PartDescriptors(const PartDescriptors&) = delete;
  PartDescriptors& operator=(const PartDescriptors&) = delete;

  /// A description that `check` finds nothing wrong with.
  void add(const EffectDescription& effect);
  void add_base_model(const BlockDescription& model);

  /// Those of a kind ("effect", "base_model") in the order in which they were added; they live as long as this object.
  const std::vector<const void*>& list(const std::string& kind) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bodeflow
