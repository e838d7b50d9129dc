#pragma once

#include <algorithm>
#include <array>
#include <bodeflow/base_model.hpp>
#include <bodeflow/effect_border.hpp>

namespace bodeflow {
namespace detail {

/// How many numbers A, B, E, Cf, Df, Ff, Cs, Ds, Fs, C, D and F of a plant have.
inline std::array<std::size_t, 12> plant_sizes(int states, int inputs, int places) {
  const auto n = static_cast<std::size_t>(states), q = static_cast<std::size_t>(inputs), m = static_cast<std::size_t>(places);
  return {n * n, n * q, n * m, m * n, m * q, m * m, m * n, m * q, m * m, n, q, m};
}

}  // namespace detail

inline namespace v0 {

/// The description of base model class B, made and checked at the first call. Throws Failure if it is wrong.
template <class B>
const BlockType& base_type() {
  static const BlockType type = [] {
    BlockDraft draft;
    Describe d(draft);
    B::describe(d);
    if (!draft.ports.empty()) fail("base model '" + draft.id + "': base models have no ports");
    return BlockType(std::move(draft), "base model");
  }();
  return type;
}

/// A base model of class B behind the C functions of bf_base_model; no exception leaves it.
template <class B>
class BaseBorder {
 public:
  static std::int32_t create(const bf_factory*, const bf_host* host, void* made) noexcept {
    return guarded(host, [&] {
      auto border = std::make_unique<BaseBorder>(*host);
      bf_base_model c{};
      c.struct_size = sizeof c;
      c.configure = configure;
      c.use_model = use_model;
      c.facts = facts;
      c.parameters = parameters;
      c.places = places;
      c.known = known;
      c.inputs = inputs;
      c.response_unit = response_unit;
      c.conventions = conventions;
      c.starts = starts;
      c.state_space = state_space;
      c.response = response;
      c.react = react;
      c.destroy = destroy;
      c.self = border.release();
      *static_cast<bf_base_model*>(made) = c;
    });
  }

  explicit BaseBorder(const bf_host& host)
      : type_(&base_type<B>()),
        values_(type_->draft().parameters.size()),
        failure_(host, "base model '" + type_->draft().id + "'") {}

 private:
  static BaseBorder& of(void* self) { return *static_cast<BaseBorder*>(self); }
  static BaseModel& model(void* self) { return of(self).model_; }

  static std::int32_t configure(void* self, const bf_parameter_value* values, std::uint32_t count,
                                const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      BaseBorder& b = of(self);
      const auto& described = b.type_->draft().parameters;
      if (count != described.size()) {
        fail("the host gives " + std::to_string(count) + " parameters; described: " + std::to_string(described.size()));
      }
      for (std::uint32_t i = 0; i < count; ++i) {
        if (values[i].type != described[i].type)
          fail("the host gives parameter '" + described[i].name + "' as another type than described");
        b.values_[i].assign(values[i]);
      }
      model(self).configure(Parameters(described, b.values_));
    });
  }
  static std::int32_t use_model(void* self, const bf_record* record, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { model(self).use_model(RecordView(*record)); });
  }

  static std::int32_t facts(void* self, bf_base_facts* facts, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      const BaseModel& m = model(self);
      const Timing timing = m.timing();
      facts->flags =
          (m.has_state_space() ? std::uint32_t{BF_BASE_STATE_SPACE} : 0u) | (m.has_laws() ? std::uint32_t{BF_BASE_LAWS} : 0u);
      facts->hold = static_cast<std::uint32_t>(timing.hold) + BF_HOLD_ZERO_ORDER;
      facts->delay_s = timing.delay_s;
      facts->filter_hz = m.filter_hz();
    });
  }
  static std::int32_t parameters(void* self, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, model(self).parameters()); });
  }
  static std::int32_t places(void* self, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, model(self).places()); });
  }
  static std::int32_t known(void* self, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, model(self).known()); });
  }
  static std::int32_t inputs(void* self, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      for (const PlantInput& input : model(self).inputs()) answer->input(answer->context, input.channel, input.derivative);
    });
  }
  static std::int32_t response_unit(void* self, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, model(self).response_unit()); });
  }
  static std::int32_t conventions(void* self, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      for (const std::string& text : model(self).conventions()) detail::give(answer, text);
    });
  }
  static std::int32_t starts(void* self, const bf_measured_response* const* measured, std::uint32_t count,
                             const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      std::vector<MeasuredResponse> list;
      for (std::uint32_t i = 0; i < count; ++i) list.push_back(detail::owned(*measured[i]));
      detail::give(answer, model(self).starts({list.data(), list.size()}));
    });
  }

  static std::int32_t state_space(void* self, const double* v, const double* known, bf_linear_plant* plant) noexcept {
    return of(self).failure_.run("state_space", std::int32_t{0}, [&] {
      LinearPlant made;
      if (!of(self).model_.state_space(v, known, made)) return 0;
      if (plant->resize(plant, made.states, made.inputs, made.places) != BF_OK) fail("no memory for the plant");
      const std::vector<double>* from[] = {&made.A,  &made.B,  &made.E,  &made.Cf, &made.Df, &made.Ff,
                                           &made.Cs, &made.Ds, &made.Fs, &made.C,  &made.D,  &made.F};
      double* to[] = {plant->A,  plant->B,  plant->E,  plant->Cf, plant->Df, plant->Ff,
                      plant->Cs, plant->Ds, plant->Fs, plant->C,  plant->D,  plant->F};
      const auto sizes = detail::plant_sizes(made.states, made.inputs, made.places);
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (from[i]->size() != sizes[i]) fail("a matrix does not have the size that the plant states");
        std::copy(from[i]->begin(), from[i]->end(), to[i]);
      }
      return 1;
    });
  }
  static std::int32_t response(void* self, const double* v, const double* known, double re, double im, double* matrix) noexcept {
    return of(self).failure_.run("response", std::int32_t{0}, [&] {
      return of(self).model_.response(v, known, {re, im}, reinterpret_cast<std::complex<double>*>(matrix)) ? 1 : 0;
    });
  }
  static void react(void* self, const double* v, const double* known, std::uint64_t place, const bf_signals* s,
                    bf_reaction* reaction) noexcept {
    const Reaction r = of(self).failure_.run("react", Reaction{detail::kNaN, 0.0, 0.0}, [&] {
      return of(self).model_.react(v, known, static_cast<std::size_t>(place), detail::owned(*s));
    });
    *reaction = {r.value, r.by_flow, r.by_stored};
  }
  static void destroy(void* self) noexcept {
    try {
      delete &of(self);
    } catch (...) {  // nobody is left to tell
    }
  }

  B model_;
  const BlockType* type_;
  std::vector<StoredValue> values_;
  detail::ToldOnce failure_;
};

template <class B>
struct FactoryOf<B, std::enable_if_t<std::is_base_of_v<BaseModel, B>>> {
  static bf_factory make() {
    const bf_block_descriptor& d = base_type<B>().c();
    return {sizeof(bf_factory), 0, "base_model", d.id, &d, BaseBorder<B>::create};
  }
};

}  // namespace v0
}  // namespace bodeflow
