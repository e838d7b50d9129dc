#include <algorithm>
#include <bodeflow/effect_proxy.hpp>
#include <bodeflow/effect_type.hpp>
#include <bodeflow/utf8.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "part_checks.hpp"
#include "test_host.hpp"

namespace bodeflow::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kHuge = 1e6;  // times what the records held: a solver's trial step comes there

using limits = std::numeric_limits<double>;

/// An effect with a host of its own.
struct MadeEffect {
  explicit MadeEffect(const bf_factory& factory) {
    bf_effect c{};
    if (factory.create(&factory, host.c(), &c) != BF_OK) fail("create fails: " + host.take_error());
    effect.emplace(c);
  }
  const detail::EffectProxy& operator*() const { return *effect; }
  const detail::EffectProxy* operator->() const { return &*effect; }

  TestHost host;
  std::optional<detail::EffectProxy> effect;
};

struct PlaceUnits {
  const char *kind, *flow, *stored, *reaction;
};
constexpr PlaceUnits kUnits[] = {{"inverter", "A", "As", "V"},       {"winding", "A", "As", "V"},  {"core", "V", "Vs", "A"},
                                 {"coil", "A", "As", "V"},           {"bearing", "m/s", "m", "N"}, {"spring", "m/s", "m", "N"},
                                 {"coupling", "rad/s", "rad", "Nm"}, {"tank", "m/s", "m", "m^3/s"}};

Situation situation(const std::string& kind) {
  Situation s;
  s.input_unit = "V";
  s.output_unit = "A";
  s.sample_time_s = 1e-3;
  s.duration_s = 4.0;
  s.input_peak = 10.0, s.input_rms = 5.0, s.output_peak = 2.0, s.output_rms = 1.0;
  s.residual_mean = 0.01, s.residual_rms = 0.05;
  for (int k = 1; k <= 20; ++k) {
    const double f = 5.0 * k;
    s.line_hz.push_back(f);
    s.response.push_back(0.2 / std::complex<double>(1.0, f / 20.0));
    s.missing.push_back(s.response.back() * std::complex<double>(0.02, -0.001 * f));
    s.missing_std.push_back(1e-4);
  }
  s.peaks_hz = {50.1, 17.3};
  s.jumps_s = {1.7};
  if (kind.empty()) return s;
  s.place.name = "place";
  s.place.kind = kind;
  s.place.flow_unit = "m/s", s.place.stored_unit = "m", s.place.reaction_unit = "N";
  for (const PlaceUnits& u : kUnits) {
    if (kind == u.kind) s.place.flow_unit = u.flow, s.place.stored_unit = u.stored, s.place.reaction_unit = u.reaction;
  }
  s.place.coefficient = 3.0, s.place.flow = 2.0, s.place.stored = 0.05, s.place.effort = 6.0;
  return s;
}

/// The first situation that the effect does not refuse.
Situation ordinary(const Effect& effect, const EffectDescription& d) {
  std::string why;
  for (const std::string& kind : d.kinds.empty() ? std::vector<std::string>{""} : d.kinds) {
    Situation s = situation(kind);
    why = effect.refuses(s);
    if (why.empty()) return s;
  }
  throw Skip{"refuses the suite's situations: " + why};
}

void expect(const std::string& problem) {
  if (!problem.empty()) fail(problem);
}

std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

/// Checks of one effect, which share its description.
class EffectChecks {
 public:
  explicit EffectChecks(const bf_factory& factory)
      : factory_(&factory), d_(effect_description(*static_cast<const bf_effect_descriptor*>(factory.descriptor))) {}

  bool is(std::initializer_list<Acts> ways) const { return std::find(ways.begin(), ways.end(), d_.acts) != ways.end(); }

  void parameters(const Step&) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    const auto parameters = e->parameters(s);
    expect(problem_of(parameters));
    const auto starts = e->starts(s);
    expect(problem_of(starts, parameters));
    if (e->starts(s) != starts) fail("gives other starts when asked again");
    const MadeEffect second(*factory_);
    if (second->starts(s) != starts || second->parameters(s).size() != parameters.size())
      fail("a second instance starts otherwise");
  }

  void words(const Step&) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      const std::vector<double> deviation(start.size(), 0.01);
      const std::string text = e->sentence(start, deviation, s);
      if (text.empty() || !is_text(text)) fail(text.empty() ? "has no words for its values" : "its words are not UTF-8");
    }
  }

  void odd_situations(const Step& step) const {
    const MadeEffect e(*factory_);
    for (const std::string& kind : d_.kinds.empty() ? std::vector<std::string>{""} : d_.kinds) {
      Situation empty;
      empty.place = situation(kind).place;
      empty.place.coefficient = empty.place.flow = empty.place.stored = empty.place.effort = 0.0;
      Situation nan = situation(kind), none = situation(kind);
      nan.input_rms = nan.output_rms = nan.residual_rms = nan.place.flow = nan.place.coefficient = limits::quiet_NaN();
      std::fill(nan.missing.begin(), nan.missing.end(), limits::infinity());
      none.line_hz.clear(), none.response.clear(), none.missing.clear(), none.missing_std.clear();
      none.peaks_hz.clear(), none.jumps_s.clear();
      for (const auto& [name, s] :
           {std::pair<const char*, const Situation*>{"nothing known", &empty}, {"NaN", &nan}, {"no lines", &none}}) {
        step(name);
        try {
          if (!e->refuses(*s).empty()) continue;
          (void)e->parameters(*s);
          (void)e->starts(*s);
        } catch (const Failure&) {  // refused with a reason
        }
      }
    }
  }

  void law(const Step& step) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      for (const double size : {0.0, 1e-9, 1.0, kHuge}) {
        for (const double sign : {1.0, -1.0}) {
          Signals x{sign * size * s.place.flow, sign * size * s.place.stored, 0.5, 1e-3, 0.1};
          step("flow " + shown(x.flow));
          react(e, start, x, true);
          x.stored = -x.stored, x.gain = 0.0;
          react(e, start, x, true);
        }
      }
      for (const double x : {limits::quiet_NaN(), limits::infinity(), -limits::infinity(), limits::max(), limits::denorm_min()}) {
        step("flow " + shown(x));
        react(e, start, {x, x, 0.5, 1e-3, 0.1}, false);
      }
    }
  }

  void law_run(const Step&) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      if (run_law(e, start, s) != run_law(e, start, s)) fail("gives other reactions when the same signals come again");
    }
  }

  void map(const Step& step) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      const double size = d_.acts == Acts::input ? s.input_peak : s.output_peak;
      for (const double scale : {1.0, kHuge}) {
        step("samples of up to " + shown(scale * size));
        const auto first = run_map(e, start, scale * size, true);
        const auto second = run_map(e, start, scale * size, true);
        if (!same_bits(first.data(), second.data(), first.size())) fail("gives other samples when the same ones come again");
      }
      step("NaN and infinite samples");
      run_map(e, start, limits::infinity(), false);
      run_map(e, start, limits::quiet_NaN(), false);
    }
  }

  void transfer(const Step&) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      for (double f = 1e-3; f < 1e6; f *= 3.0) {
        const std::complex<double> at(0.0, 2.0 * kPi * f);
        const auto z = e->transfer(start.data(), at), again = e->transfer(start.data(), at),
                   mirror = e->transfer(start.data(), std::conj(at));
        if (!std::isfinite(z.real()) || !std::isfinite(z.imag())) fail("is not finite at " + shown(f) + " Hz" + told(e));
        if (z != again) fail("is another at " + shown(f) + " Hz when asked again");
        if (!(std::abs(mirror - std::conj(z)) <= 1e-9 * std::abs(z)))
          fail("is no real law: at -" + shown(f) + " Hz it is not the conjugate");
      }
      (void)e->transfer(start.data(), 0.0);
    }
  }

  void delay(const Step&) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      const double d = e->delay_s(start.data());
      if (!std::isfinite(d) || d != e->delay_s(start.data())) fail("delays by " + shown(d) + " s" + told(e));
    }
  }

  void tones(const Step&) const {
    const MadeEffect e(*factory_);
    const Situation s = ordinary(*e, d_);
    for (const auto& start : e->starts(s)) {
      const auto f = e->tones_hz(start.data());
      if (f.empty() || f != e->tones_hz(start.data())) fail(f.empty() ? "has no tone" : "has other tones when asked again");
      for (const double x : f) {
        if (!std::isfinite(x) || x < 0.0) fail("has a tone at " + shown(x) + " Hz");
      }
    }
  }

 private:
  static std::string told(const MadeEffect& e) { return e.host.log().empty() ? "" : ": " + e.host.log(); }

  std::size_t memory() const { return d_.memory; }

  /// One call, twice with other numbers in the place of the answer; where `finite`, the answer is to be.
  void react(const MadeEffect& effect, const std::vector<double>& start, const Signals& x, bool finite) const {
    GuardedBuffer before(memory(), sizeof(double), 0), first(memory(), sizeof(double), 0x00),
        second(memory(), sizeof(double), 0x11);
    auto* next = static_cast<double*>(first.data());
    const auto* zeros = static_cast<const double*>(before.data());
    const Reaction r = effect->react(start.data(), x, zeros, next);
    const Reaction again = effect->react(start.data(), x, zeros, static_cast<double*>(second.data()));
    const std::vector<double> untouched(memory(), 0.0);
    if (!first.intact() || !second.intact()) fail("writes beyond its memory of " + std::to_string(memory()) + " numbers");
    if (!before.intact() || !same_bits(zeros, untouched.data(), memory())) fail("writes into the memory of the step before");
    if (!finite) return;
    if (!std::isfinite(r.value) || !std::isfinite(r.by_flow) || !std::isfinite(r.by_stored))
      fail("the reaction or a slope is not finite" + told(effect));
    if (!same_bits(next, static_cast<double*>(second.data()), memory()))
      fail("leaves numbers of its memory unwritten, or reads them");
    if (r.value != again.value || r.by_flow != again.by_flow) fail("gives another reaction when asked again");
  }

  /// The reactions to a decaying oscillation.
  std::vector<double> run_law(const MadeEffect& effect, const std::vector<double>& start, const Situation& s) const {
    std::vector<double> old(memory(), 0.0), next(memory(), 0.0), reactions;
    for (int n = 0; n < 1000; ++n) {
      const double t = 1e-3 * n, envelope = std::exp(-t);
      const Signals x{s.place.flow * envelope * std::sin(40.0 * t), s.place.stored * envelope * std::cos(40.0 * t), t, 1e-3, 0.1};
      const Reaction r = effect->react(start.data(), x, old.data(), next.data());
      if (!std::isfinite(r.value)) fail("the reaction is not finite at step " + std::to_string(n) + told(effect));
      reactions.push_back(r.value);
      old.swap(next);
    }
    return reactions;
  }

  std::vector<double> run_map(const MadeEffect& effect, const std::vector<double>& start, double size, bool finite) const {
    GuardedBuffer memory(d_.memory, sizeof(double), 0);
    std::vector<double> samples;
    for (int n = 0; n < 1000; ++n) {
      const double x = size * std::sin(0.05 * n), y = effect->map(start.data(), x, 1e-3 * n, static_cast<double*>(memory.data()));
      if (finite && !std::isfinite(y)) fail("the sample for " + shown(x) + " is not finite" + told(effect));
      samples.push_back(y);
    }
    if (!memory.intact()) fail("writes beyond its memory of " + std::to_string(d_.memory) + " numbers");
    return samples;
  }

  const bf_factory* factory_;
  EffectDescription d_;
};

}  // namespace

std::vector<PartCheck> effect_checks(const bf_factory& factory) {
  const EffectChecks checks(factory);
  std::vector<PartCheck> list;
  const auto add = [&](const char* name, void (EffectChecks::*run)(const Step&) const) {
    list.push_back({name, [checks, run](const Step& step) { (checks.*run)(step); }});
  };
  add("states sound parameters and starts inside their bounds", &EffectChecks::parameters);
  add("has words for its values", &EffectChecks::words);
  add("takes or refuses situations of which little is known", &EffectChecks::odd_situations);
  if (checks.is({Acts::law})) {
    add("reacts finitely, from its arguments alone, and writes its own memory", &EffectChecks::law);
    add("gives the same reactions to the same signals", &EffectChecks::law_run);
  }
  if (checks.is({Acts::input, Acts::output})) add("maps samples finitely, and the same ones alike", &EffectChecks::map);
  if (checks.is({Acts::immittance, Acts::series, Acts::parallel}))
    add("has a finite and real transfer at every frequency", &EffectChecks::transfer);
  if (checks.is({Acts::delay})) add("has a finite delay", &EffectChecks::delay);
  if (checks.is({Acts::tone})) add("has finite tones", &EffectChecks::tones);
  return list;
}

}  // namespace bodeflow::testing
