#pragma once

#include <bodeflow/answer.hpp>
#include <memory>

namespace bodeflow::detail {

/// What the factory of a part made; destroyed with it.
template <class C>
struct OwnedPart {
  C c;
  explicit OwnedPart(const C& made) : c(made) {}
  ~OwnedPart() {
    if (c.destroy != nullptr) c.destroy(c.self);
  }
  OwnedPart(const OwnedPart&) = delete;
  OwnedPart& operator=(const OwnedPart&) = delete;
};

/// An effect of whatever plugin.
class EffectProxy final : public Effect {
 public:
  /// Takes over `c`. Throws Failure for one that is not complete.
  explicit EffectProxy(const bf_effect& c) : part_(c) {
    const bool complete = c.struct_size >= sizeof c && c.refuses && c.parameters && c.starts && c.sentence && c.react && c.map &&
                          c.transfer && c.delay_s && c.tones_hz && c.destroy;
    if (!complete) fail("the plugin made an effect without all its functions");
  }

  std::string refuses(const Situation& s) const override {
    Answer answer;
    answer.check(c().refuses(c().self, BorrowedSituation(s).c(), answer.c()));
    return answer.texts.empty() ? std::string() : answer.texts.front();
  }
  std::vector<FitParameter> parameters(const Situation& s) const override {
    Answer answer;
    answer.check(c().parameters(c().self, BorrowedSituation(s).c(), answer.c()));
    return std::move(answer.parameters);
  }
  std::vector<std::vector<double>> starts(const Situation& s) const override {
    Answer answer;
    answer.check(c().starts(c().self, BorrowedSituation(s).c(), answer.c()));
    return std::move(answer.values);
  }
  std::string sentence(std::span<const double> value, std::span<const double> deviation, const Situation& s) const override {
    Answer answer;
    const bf_numbers values = borrowed(value), deviations = borrowed(deviation);
    answer.check(c().sentence(c().self, &values, &deviations, BorrowedSituation(s).c(), answer.c()));
    return answer.texts.empty() ? std::string() : answer.texts.front();
  }

  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override {
    Reaction r;
    c().react(c().self, p, borrowed(s), memory, next, borrowed(r));
    return r;
  }
  double map(const double* p, double x, double time_s, double* memory) const override {
    return c().map(c().self, p, x, time_s, memory);
  }
  std::complex<double> transfer(const double* p, std::complex<double> s) const override {
    double z[2];
    c().transfer(c().self, p, s.real(), s.imag(), z);
    return {z[0], z[1]};
  }
  double delay_s(const double* p) const override { return c().delay_s(c().self, p); }
  std::vector<double> tones_hz(const double* p) const override {
    Answer answer;
    answer.check(c().tones_hz(c().self, p, answer.c()));
    return answer.values.empty() ? std::vector<double>() : std::move(answer.values.front());
  }

 private:
  const bf_effect& c() const { return part_.c; }

  OwnedPart<bf_effect> part_;
};

}  // namespace bodeflow::detail
