#include "plugins/part_descriptors.hpp"

#include <fmt/format.h>

#include <bodeflow/block_type.hpp>
#include <bodeflow/effect_type.hpp>

namespace bodeflow {
namespace {

ParameterDraft draft_of(const ParameterDescription& p) {
  ParameterDraft d;
  d.type = p.type;
  d.required = p.required;
  d.live = p.live;
  d.exclusive_minimum = p.exclusive_minimum;
  d.exclusive_maximum = p.exclusive_maximum;
  d.name = p.name;
  d.unit = p.unit;
  d.doc = p.doc;
  d.aliases = fmt::format("{}", fmt::join(p.aliases, " "));
  d.choices = p.choices;
  d.minimum = p.minimum;
  d.maximum = p.maximum;
  d.fallback.assign(ParameterView(p.fallback).c());
  return d;
}

BlockDraft draft_of(const BlockDescription& model) {
  BlockDraft draft;
  draft.id = model.id;
  draft.summary = model.summary;
  draft.doc = model.doc;
  draft.references = model.references;
  for (const ParameterDescription& p : model.parameters) draft.parameters.push_back(draft_of(p));
  return draft;
}

}  // namespace

struct PartDescriptors::State {
  std::vector<std::unique_ptr<EffectType>> effect_types;
  std::vector<std::unique_ptr<BlockType>> base_types;
  std::vector<const void*> effects, base_models, none;
};

PartDescriptors::PartDescriptors() : state_(std::make_unique<State>()) {}
PartDescriptors::~PartDescriptors() = default;

void PartDescriptors::add(const EffectDescription& effect) {
  state_->effect_types.push_back(std::make_unique<EffectType>(effect));
  state_->effects.push_back(&state_->effect_types.back()->c());
}

void PartDescriptors::add_base_model(const BlockDescription& model) {
  state_->base_types.push_back(std::make_unique<BlockType>(draft_of(model), "base model"));
  state_->base_models.push_back(&state_->base_types.back()->c());
}

const std::vector<const void*>& PartDescriptors::list(const std::string& kind) const {
  return kind == "effect" ? state_->effects : kind == "base_model" ? state_->base_models : state_->none;
}

}  // namespace bodeflow
