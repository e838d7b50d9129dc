#pragma once

#include <bodeflow/abi.h>

#include <algorithm>
#include <bodeflow/effect_description.hpp>
#include <bodeflow/error.hpp>
#include <bodeflow/words.hpp>
#include <string>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// Numbers that an effect may keep from step to step, at most; and steps of the simulation that it may ask for in a sample.
inline constexpr std::size_t kMostEffectMemory = 65536;
inline constexpr int kMostStepsPerSample = 4096;

/// A word for a way to act: "law", "immittance" ...
inline const char* acts_name(Acts acts) {
  constexpr const char* kNames[] = {"law", "immittance", "input", "output", "series", "parallel", "delay", "tone"};
  return kNames[static_cast<int>(acts)];
}

/// The checked description of an effect class and the C descriptor that points into it. Lives as long as the plugin.
class EffectType {
 public:
  /// Throws Failure with everything that is wrong with the description, a line each.
  explicit EffectType(EffectDescription description) : d_(std::move(description)) {
    check();
    for (const std::string& kind : d_.kinds) kinds_.push_back(kind.c_str());
    for (const std::string& name : d_.equivalents) equivalents_.push_back(name.c_str());
    c_.struct_size = sizeof c_;
    c_.flags = (d_.rough ? std::uint32_t{BF_EFFECT_ROUGH} : 0u) |
               (d_.nonstationary ? std::uint32_t{BF_EFFECT_NONSTATIONARY} : 0u) |
               (d_.memoryless_linear ? std::uint32_t{BF_EFFECT_MEMORYLESS_LINEAR} : 0u);
    c_.acts = static_cast<std::uint32_t>(d_.acts) + BF_ACTS_LAW;
    c_.steps_per_sample = static_cast<std::uint32_t>(d_.steps_per_sample);
    c_.memory = d_.memory;
    c_.kind_count = static_cast<std::uint32_t>(kinds_.size());
    c_.equivalent_count = static_cast<std::uint32_t>(equivalents_.size());
    c_.id = d_.id.c_str();
    c_.summary = d_.summary.c_str();
    c_.doc = d_.doc.c_str();
    c_.references = d_.references.c_str();
    c_.separation = d_.separation.c_str();
    c_.kinds = kinds_.data();
    c_.equivalents = equivalents_.data();
  }
  EffectType(const EffectType&) = delete;
  EffectType& operator=(const EffectType&) = delete;

  const EffectDescription& description() const { return d_; }
  const bf_effect_descriptor& c() const { return c_; }

 private:
  void wrong(const std::string& what) {
    if (!problems_.empty()) problems_ += '\n';
    problems_ += "effect '" + d_.id + "': " + what;
  }

  void check() {
    if (!detail::is_dotted(d_.id, 2, 2)) wrong("id has not the form family.name (lower-case letters, digits, _)");
    if (d_.summary.empty()) wrong("summary is missing");
    const std::string acts = std::string("acts as ") + acts_name(d_.acts);
    const bool at_place = d_.acts == Acts::law || d_.acts == Acts::immittance;
    const bool keeps = d_.acts == Acts::law || d_.acts == Acts::input || d_.acts == Acts::output;
    if (at_place && d_.kinds.empty()) wrong(acts + ", but names no kind of place: acts(Acts::law, {\"bearing\"})");
    if (!at_place && !d_.kinds.empty()) wrong(acts + ": only laws and immittances have kinds of places");
    if (!keeps && d_.memory != 0) wrong(acts + ": only laws, inputs and outputs have a memory");
    if (d_.memory > kMostEffectMemory) {
      wrong("memory of " + std::to_string(d_.memory) + " numbers; allowed: at most " + std::to_string(kMostEffectMemory));
    }
    if (d_.steps_per_sample < 1 || d_.steps_per_sample > kMostStepsPerSample) {
      wrong("steps_per_sample is " + std::to_string(d_.steps_per_sample) + "; allowed: 1 to " +
            std::to_string(kMostStepsPerSample));
    }
    names(d_.kinds, "kind of place");
    names(d_.equivalents, "equivalent");
    if (!problems_.empty()) fail(problems_);
  }

  void names(const std::vector<std::string>& list, const std::string& what) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!detail::is_word(list[i])) wrong(what + " '" + list[i] + "' is not a word of lower-case letters, digits and _");
      if (std::find(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(i), list[i]) !=
          list.begin() + static_cast<std::ptrdiff_t>(i)) {
        wrong(what + " '" + list[i] + "' stands twice");
      }
    }
  }

  EffectDescription d_;
  std::string problems_;
  std::vector<const char*> kinds_, equivalents_;
  bf_effect_descriptor c_{};
};

/// A copy of a C descriptor, which a host or an EffectType made.
inline EffectDescription effect_description(const bf_effect_descriptor& c) {
  const auto text = [](const char* t) { return t == nullptr ? std::string() : std::string(t); };
  EffectDescription d;
  d.id = text(c.id);
  d.summary = text(c.summary);
  d.doc = text(c.doc);
  d.references = text(c.references);
  d.separation = text(c.separation);
  d.acts = static_cast<Acts>(c.acts - BF_ACTS_LAW);
  d.kinds.assign(c.kinds, c.kinds + c.kind_count);
  d.equivalents.assign(c.equivalents, c.equivalents + c.equivalent_count);
  d.memory = static_cast<std::size_t>(c.memory);
  d.steps_per_sample = static_cast<int>(c.steps_per_sample);
  d.rough = (c.flags & BF_EFFECT_ROUGH) != 0;
  d.nonstationary = (c.flags & BF_EFFECT_NONSTATIONARY) != 0;
  d.memoryless_linear = (c.flags & BF_EFFECT_MEMORYLESS_LINEAR) != 0;
  return d;
}

}  // namespace v0
}  // namespace bodeflow
