#pragma once

#include <atomic>
#include <bodeflow/answer.hpp>
#include <bodeflow/effect_type.hpp>
#include <bodeflow/plugin.hpp>
#include <limits>
#include <memory>
#include <type_traits>

namespace bodeflow {
namespace detail {

/// Tells once that a function of a part without a way to fail has failed. Any thread.
class ToldOnce {
 public:
  ToldOnce(const bf_host& host, std::string part) : services_(host), part_(std::move(part)) {}

  /// Runs `work`; an exception of whatever type gives `otherwise` and is told if it is the first.
  template <class T, class Work>
  T run(const char* function, T otherwise, Work&& work) noexcept {
    try {
      return work();
    } catch (const std::exception& e) {
      tell(function, e.what());
    } catch (...) {
      tell(function, "an exception that is not derived from std::exception");
    }
    return otherwise;
  }

 private:
  void tell(const char* function, const char* why) noexcept {
    if (told_.exchange(true)) return;
    try {
      services_.log(BF_LOG_WARNING, part_ + ": " + function + " failed and gives no number: " + why + " (told once)");
    } catch (...) {  // the line is lost
    }
  }

  Services services_;
  std::string part_;
  std::atomic<bool> told_{false};
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace detail

inline namespace v0 {

/// The description of effect class E, made and checked at the first call. Throws Failure if it is wrong.
template <class E>
const EffectType& effect_type() {
  static const EffectType type = [] {
    EffectDescription description;
    DescribeEffect d(description);
    E::describe(d);
    return EffectType(std::move(description));
  }();
  return type;
}

/// An effect of class E behind the C functions of bf_effect; no exception leaves it.
template <class E>
class EffectBorder {
 public:
  static std::int32_t create(const bf_factory*, const bf_host* host, void* made) noexcept {
    return guarded(host, [&] {
      auto border = std::make_unique<EffectBorder>(*host);
      bf_effect c{};
      c.struct_size = sizeof c;
      c.refuses = refuses;
      c.parameters = parameters;
      c.starts = starts;
      c.sentence = sentence;
      c.react = react;
      c.map = map;
      c.transfer = transfer;
      c.delay_s = delay_s;
      c.tones_hz = tones_hz;
      c.destroy = destroy;
      c.self = border.release();
      *static_cast<bf_effect*>(made) = c;
    });
  }

  explicit EffectBorder(const bf_host& host) : failure_(host, "effect '" + effect_type<E>().description().id + "'") {}

 private:
  static EffectBorder& of(void* self) { return *static_cast<EffectBorder*>(self); }
  static const Effect& effect(void* self) { return of(self).effect_; }

  static std::int32_t refuses(void* self, const bf_situation* s, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      const std::string why = effect(self).refuses(detail::owned(*s));
      if (!why.empty()) detail::give(answer, why);
    });
  }
  static std::int32_t parameters(void* self, const bf_situation* s, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, effect(self).parameters(detail::owned(*s))); });
  }
  static std::int32_t starts(void* self, const bf_situation* s, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, effect(self).starts(detail::owned(*s))); });
  }
  static std::int32_t sentence(void* self, const bf_numbers* value, const bf_numbers* deviation, const bf_situation* s,
                               const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] {
      const std::span<const double> values(value->values, value->count), deviations(deviation->values, deviation->count);
      detail::give(answer, effect(self).sentence(values, deviations, detail::owned(*s)));
    });
  }

  static void react(void* self, const double* p, const bf_signals* s, const double* memory, double* next,
                    bf_reaction* reaction) noexcept {
    const Reaction r = of(self).failure_.run("react", Reaction{detail::kNaN, 0.0, 0.0},
                                             [&] { return of(self).effect_.react(p, detail::owned(*s), memory, next); });
    *reaction = {r.value, r.by_flow, r.by_stored};
  }
  static double map(void* self, const double* p, double x, double time_s, double* memory) noexcept {
    return of(self).failure_.run("map", detail::kNaN, [&] { return of(self).effect_.map(p, x, time_s, memory); });
  }
  static void transfer(void* self, const double* p, double re, double im, double* result) noexcept {
    const std::complex<double> z = of(self).failure_.run("transfer", std::complex<double>(detail::kNaN, detail::kNaN), [&] {
      return of(self).effect_.transfer(p, {re, im});
    });
    result[0] = z.real();
    result[1] = z.imag();
  }
  static double delay_s(void* self, const double* p) noexcept {
    return of(self).failure_.run("delay_s", detail::kNaN, [&] { return of(self).effect_.delay_s(p); });
  }
  static std::int32_t tones_hz(void* self, const double* p, const bf_answer* answer) noexcept {
    return detail::answered(answer, [&] { detail::give(answer, effect(self).tones_hz(p)); });
  }
  static void destroy(void* self) noexcept {
    try {
      delete &of(self);
    } catch (...) {  // nobody is left to tell
    }
  }

  E effect_;
  detail::ToldOnce failure_;
};

template <class E>
struct FactoryOf<E, std::enable_if_t<std::is_base_of_v<Effect, E>>> {
  static bf_factory make() {
    const bf_effect_descriptor& d = effect_type<E>().c();
    return {sizeof(bf_factory), 0, "effect", d.id, &d, EffectBorder<E>::create};
  }
};

}  // namespace v0
}  // namespace bodeflow
