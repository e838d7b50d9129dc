#pragma once

#include <bodeflow/effect.hpp>
#include <memory>
#include <vector>

/// The linear effects of the catalogue, for tests.
namespace bodeflow::residual::testing {

struct Linear {
  EffectDescription what;
  std::shared_ptr<const Effect> effect;
};

template <class E>
Linear linear() {
  Linear t;
  DescribeEffect describe(t.what);
  E::describe(describe);
  t.effect = std::make_shared<E>();
  return t;
}

std::vector<Linear> linear_effects();

}  // namespace bodeflow::residual::testing
