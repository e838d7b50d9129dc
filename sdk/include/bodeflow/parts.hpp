#pragma once

// Effects and base models: to write them (derive from Effect or BaseModel, describe, name in BODEFLOW_PLUGIN), and to use those
// of all plugins in a block (Parts).
#include <bodeflow/base_border.hpp>
#include <bodeflow/base_proxy.hpp>
#include <bodeflow/block_base.hpp>
#include <bodeflow/declarations.hpp>
#include <bodeflow/effect_type.hpp>
#include <memory>
#include <optional>

namespace bodeflow {
inline namespace v0 {

/// What is static about a base model.
struct BaseDescription {
  std::string id, summary, doc, references;
  std::vector<ParameterDraft> parameters;  ///< what can be declared
};

}  // namespace v0

namespace detail {

inline ParameterDraft owned(const bf_parameter_descriptor& c) {
  ParameterDraft p;
  p.type = c.type;
  p.required = (c.flags & BF_PARAMETER_REQUIRED) != 0;
  p.live = (c.flags & BF_PARAMETER_LIVE) != 0;
  p.exclusive_minimum = (c.flags & BF_PARAMETER_EXCLUSIVE_MIN) != 0;
  p.exclusive_maximum = (c.flags & BF_PARAMETER_EXCLUSIVE_MAX) != 0;
  p.name = text(c.name);
  p.unit = text(c.unit);
  p.doc = text(c.doc);
  p.aliases = text(c.aliases);
  p.choices.assign(c.choices, c.choices + c.choice_count);
  p.minimum = c.minimum;
  p.maximum = c.maximum;
  p.fallback.assign(c.fallback);
  p.fallback.type = c.type;
  p.fallback.given = false;
  return p;
}

inline BaseDescription owned(const bf_block_descriptor& c) {
  BaseDescription d{text(c.id), text(c.summary), text(c.doc), text(c.references), {}};
  for (std::uint32_t i = 0; i < c.parameter_count; ++i) d.parameters.push_back(owned(*c.parameters[i]));
  return d;
}

}  // namespace detail

inline namespace v0 {

/// The effects and base models of all plugins, for a block: `parts()`. What it makes lives no longer than the block. Any thread.
class Parts {
 public:
  explicit Parts(const bf_host& host)
      : host_(&host), parts_(static_cast<const bf_parts*>(host.extension(&host, BF_EXTENSION_PARTS))) {}

  /// Ordered by id.
  std::vector<EffectDescription> effects() const {
    std::vector<EffectDescription> list;
    each<bf_effect_descriptor>(kEffect, [&](const bf_effect_descriptor& c) { list.push_back(effect_description(c)); });
    return list;
  }
  std::vector<BaseDescription> base_models() const {
    std::vector<BaseDescription> list;
    each<bf_block_descriptor>(kBase, [&](const bf_block_descriptor& c) { list.push_back(detail::owned(c)); });
    return list;
  }

  /// The effect of that id; its plugin is loaded where it is not yet. Throws Failure: no plugin gives it (with the nearest id).
  std::shared_ptr<const Effect> effect(std::string_view id) const {
    std::vector<std::string> ids;
    each<bf_effect_descriptor>(kEffect, [&](const bf_effect_descriptor& c) { ids.push_back(c.id); });
    require(id, ids, "effect");
    bf_effect c{};
    make(kEffect, id, &c);
    return std::make_shared<const detail::EffectProxy>(c);
  }

  /// The base model of that id with declared values: "name=value", with units. `model` is a record for a black box that takes
  /// one. Throws Failure: no plugin gives it, or a declaration is wrong (what was found, what is allowed, the nearest name), or
  /// in the words of the model.
  std::shared_ptr<const BaseModel> base_model(std::string_view id, const std::vector<std::string>& declarations = {},
                                              const std::optional<RecordView>& model = {}) const {
    std::vector<std::string> ids;
    const bf_block_descriptor* found = nullptr;
    each<bf_block_descriptor>(kBase, [&](const bf_block_descriptor& c) {
      ids.push_back(c.id);
      if (id == c.id) found = &c;
    });
    require(id, ids, "base model");
    const auto values = declared_values(detail::owned(*found).parameters, declarations, "base model '" + std::string(id) + "'");
    bf_base_model c{};
    make(kBase, id, &c);
    if (!model) return std::make_shared<const detail::BaseProxy>(c, values, nullptr);
    const auto bytes = model->bytes();
    const bf_record record{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
    return std::make_shared<const detail::BaseProxy>(c, values, &record);
  }

 private:
  static constexpr const char* kEffect = "effect";
  static constexpr const char* kBase = "base_model";

  template <class Descriptor, class Take>
  void each(const char* kind, Take&& take) const {
    if (parts_ == nullptr) return;
    std::uint32_t count = 0;
    const void* const* list = parts_->list(host_, kind, &count);
    for (std::uint32_t i = 0; i < count; ++i) take(*static_cast<const Descriptor*>(list[i]));
  }

  static void require(std::string_view id, const std::vector<std::string>& ids, const std::string& what) {
    if (std::find(ids.begin(), ids.end(), id) != ids.end()) return;
    fail("no plugin gives the " + what + " '" + std::string(id) + "'" + detail::meant(id, ids));
  }

  void make(const char* kind, std::string_view id, void* made) const {
    if (parts_->create(host_, kind, std::string(id).c_str(), made) != BF_OK) throw Services::HostRefused();
  }

  const bf_host* host_;
  const bf_parts* parts_;
};

inline Parts Block::parts() const { return Parts(services_.host()); }

}  // namespace v0
}  // namespace bodeflow
