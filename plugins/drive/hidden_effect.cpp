#include "hidden_effect.hpp"

#include <algorithm>
#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

using numerics::refused;
using records::short_number;

// Streams of the seed.
constexpr std::uint64_t kWhich = 0, kSize = 1, kMotor = 2, kHow = 3, kSecond = 4, kSecondSize = 5;
constexpr double kSumWithin = 1e-9;  // of odds that add up to 1

using Kinds = std::vector<const EffectKind*>;

std::string all_names(EffectTable table) {
  std::string text;
  for (const EffectKind& kind : table) text += (text.empty() ? "" : ", ") + std::string(kind.name);
  return text;
}

std::optional<std::string> what_is_wrong(const EffectKind& kind, const SizeRange& range) {
  if (range.least > 0 && range.greatest >= range.least && std::isfinite(range.greatest)) return std::nullopt;
  return "size." + std::string(kind.name) + " is from " + short_number(range.least) + " to " + short_number(range.greatest) +
         ", allowed: two values above 0, the first not above the second";
}

numerics::Expected<Kinds> kinds_of(const Draw& d, const std::vector<std::string>& names, const char* list) {
  Kinds kinds;
  for (const std::string& name : names) {
    const EffectKind* const kind = find_effect(d.table, name);
    if (kind == nullptr) return refused(std::string(list) + ": unknown effect '" + name + "', allowed: " + all_names(d.table));
    kinds.push_back(kind);
    if (kind == d.table.data()) continue;
    const auto wrong = what_is_wrong(*kind, d.ranges[static_cast<std::size_t>(kind - d.table.data())]);
    if (wrong) return refused(*wrong);
  }
  return kinds;
}

const EffectKind* one_of(const Kinds& kinds, std::uint64_t seed, std::uint64_t stream) {
  const double place = numerics::Random::stream(seed, stream).uniform() * static_cast<double>(kinds.size());
  return kinds[std::min(static_cast<std::size_t>(place), kinds.size() - 1)];
}

HiddenEffect sized(const Draw& d, const EffectKind* kind, std::uint64_t seed, std::uint64_t stream) {
  const SizeRange& range = d.ranges[static_cast<std::size_t>(kind - d.table.data())];
  const double part = numerics::Random::stream(seed, stream).uniform();
  return {kind, std::clamp(range.least * std::pow(range.greatest / range.least, part), range.least, range.greatest)};
}

Kinds unlike(const Kinds& kinds, const EffectKind* first) {
  Kinds others;
  std::copy_if(kinds.begin(), kinds.end(), std::back_inserter(others),
               [first](const EffectKind* k) { return k->likeness != first->likeness; });
  return others;
}

std::optional<std::string> what_is_wrong(const Odds& o, const Kinds& effects, const Kinds& outside) {
  const double sum = o.none + o.one + o.two + o.outside;
  if (!(o.none >= 0 && o.one >= 0 && o.two >= 0 && o.outside >= 0 && std::abs(sum - 1) < kSumWithin)) {
    return "odds are " + short_number(o.none) + ", " + short_number(o.one) + ", " + short_number(o.two) + ", " +
           short_number(o.outside) + ", allowed: four shares from 0 that add up to 1";
  }
  if (o.one + o.two > 0 && effects.empty()) return "odds ask for an effect, and effects names none";
  const bool pairs = std::all_of(effects.begin(), effects.end(), [&](const auto* k) { return !unlike(effects, k).empty(); });
  if (o.two > 0 && !pairs) return "odds ask for two effects, and effects has no two that do not act alike";
  if (o.outside > 0 && outside.empty()) return "odds ask for an effect outside, and outside names none";
  return std::nullopt;
}

}  // namespace

const EffectKind* find_effect(EffectTable table, const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const EffectKind& k) { return k.name == name; });
  return found == table.end() ? nullptr : &*found;
}

numerics::Expected<std::vector<HiddenEffect>> draw_effects(std::uint64_t seed, const Draw& d) {
  const EffectKind* const none = d.table.data();
  if (d.effects.empty()) return refused("effects is empty, allowed: one or more of " + all_names(d.table));
  auto effects = kinds_of(d, d.effects, "effects");
  if (!effects) return refused(effects.error().text);
  auto outside = kinds_of(d, d.outside, "outside");
  if (!outside) return refused(outside.error().text);
  using Hidden = std::vector<HiddenEffect>;
  if (!d.odds) {
    const EffectKind* const kind = one_of(*effects, seed, kWhich);
    return kind == none ? Hidden{} : Hidden{sized(d, kind, seed, kSize)};
  }
  effects->erase(std::remove(effects->begin(), effects->end(), none), effects->end());
  outside->erase(std::remove(outside->begin(), outside->end(), none), outside->end());
  if (const auto wrong = what_is_wrong(*d.odds, *effects, *outside)) return refused(*wrong);
  const double how = numerics::Random::stream(seed, kHow).uniform();
  if (how < d.odds->none) return Hidden{};
  if (how >= 1 - d.odds->outside) return Hidden{sized(d, one_of(*outside, seed, kWhich), seed, kSize)};
  Hidden hidden{sized(d, one_of(*effects, seed, kWhich), seed, kSize)};
  if (how >= d.odds->none + d.odds->one)
    hidden.push_back(sized(d, one_of(unlike(*effects, hidden[0].kind), seed, kSecond), seed, kSecondSize));
  return hidden;
}

numerics::Expected<MotorParameters> draw_motor(std::uint64_t seed, const MotorParameters& nominal, double spread) {
  if (const auto good = checked(nominal); !good) return tl::unexpected(good.error());
  if (nominal.lm > std::min(nominal.ls, nominal.lr)) {
    return refused("lm is " + std::to_string(nominal.lm) + " H, allowed: at most ls, " + std::to_string(nominal.ls) +
                   " H, and lr, " + std::to_string(nominal.lr) + " H");
  }
  const std::vector<double> v =
      draw_near(seed, {nominal.rs, nominal.rr, nominal.lm, nominal.ls - nominal.lm, nominal.lr - nominal.lm}, spread);
  return MotorParameters{v[0], v[1], v[2] + v[3], v[2] + v[4], v[2]};
}

std::vector<double> draw_near(std::uint64_t seed, const std::vector<double>& nominal, double spread) {
  numerics::Random random = numerics::Random::stream(seed, kMotor);
  std::vector<double> values;
  for (const double value : nominal) values.push_back(value * (1 + spread * (2 * random.uniform() - 1)));
  return values;
}

}  // namespace bodeflow::drive
