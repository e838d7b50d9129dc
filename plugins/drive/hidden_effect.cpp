#include "hidden_effect.hpp"

#include <algorithm>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <optional>

#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

// Streams of the seed.
constexpr std::uint64_t kWhich = 0, kSize = 1, kMotor = 2;

std::string all_names() {
  std::string text;
  for (const EffectKind& kind : kEffects) text += (text.empty() ? "" : ", ") + std::string(kind.name);
  return text;
}

std::optional<std::string> what_is_wrong(const EffectKind& kind, const SizeRange& range) {
  if (range.least > 0 && range.greatest >= range.least && std::isfinite(range.greatest)) return std::nullopt;
  return "size." + std::string(kind.name) + " is from " + records::short_number(range.least) + " to " +
         records::short_number(range.greatest) + ", allowed: two values above 0, the first not above the second";
}

}  // namespace

const EffectKind* find_effect(const std::string& name) {
  const auto* const found = std::find_if(kEffects.begin(), kEffects.end(), [&](const EffectKind& k) { return k.name == name; });
  return found == kEffects.end() ? nullptr : found;
}

numerics::Expected<HiddenEffect> draw_effect(std::uint64_t seed, const std::vector<std::string>& names,
                                             const std::array<SizeRange, kEffects.size()>& ranges) {
  if (names.empty()) return numerics::refused("effects is empty, allowed: one or more of " + all_names());
  for (const std::string& name : names) {
    const EffectKind* const kind = find_effect(name);
    if (kind == nullptr) return numerics::refused("effects: unknown effect '" + name + "', allowed: " + all_names());
    if (kind == kEffects.begin()) continue;
    const auto wrong = what_is_wrong(*kind, ranges[static_cast<std::size_t>(kind - kEffects.begin())]);
    if (wrong) return numerics::refused(*wrong);
  }
  const double place = numerics::Random::stream(seed, kWhich).uniform() * static_cast<double>(names.size());
  const EffectKind* const kind = find_effect(names[std::min(static_cast<std::size_t>(place), names.size() - 1)]);
  if (kind == kEffects.begin()) return HiddenEffect{kind, 0.0};
  const SizeRange& range = ranges[static_cast<std::size_t>(kind - kEffects.begin())];
  const double part = numerics::Random::stream(seed, kSize).uniform();
  const double size = range.least * std::pow(range.greatest / range.least, part);
  return HiddenEffect{kind, std::clamp(size, range.least, range.greatest)};
}

numerics::Expected<MotorParameters> draw_motor(std::uint64_t seed, const MotorParameters& nominal, double spread) {
  if (const auto good = checked(nominal); !good) return tl::unexpected(good.error());
  if (nominal.lm > std::min(nominal.ls, nominal.lr)) {
    return numerics::refused("lm is " + std::to_string(nominal.lm) + " H, allowed: at most ls, " + std::to_string(nominal.ls) +
                             " H, and lr, " + std::to_string(nominal.lr) + " H");
  }
  numerics::Random random = numerics::Random::stream(seed, kMotor);
  const auto drawn = [&](double value) { return value * (1 + spread * (2 * random.uniform() - 1)); };
  MotorParameters motor;
  motor.rs = drawn(nominal.rs);
  motor.rr = drawn(nominal.rr);
  motor.lm = drawn(nominal.lm);
  motor.ls = motor.lm + drawn(nominal.ls - nominal.lm);
  motor.lr = motor.lm + drawn(nominal.lr - nominal.lm);
  return motor;
}

}  // namespace bodeflow::drive
