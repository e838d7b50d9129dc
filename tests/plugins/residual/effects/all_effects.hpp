#pragma once

#include <bodeflow/effect.hpp>
#include <memory>
#include <string>
#include <vector>

/// The laws, maps and tones of the catalogue, for tests that hold for each of them.
namespace bodeflow::residual::testing {

struct Tried {
  EffectDescription what;
  std::shared_ptr<const Effect> effect;
};

template <class E>
Tried tried() {
  Tried t;
  DescribeEffect describe(t.what);
  E::describe(describe);
  t.effect = std::make_shared<E>();
  return t;
}

std::vector<Tried> laws_maps_and_tones();

/// What a tracer would say of a place of that kind, and of the signals.
Situation situation(const std::string& kind);

}  // namespace bodeflow::residual::testing
