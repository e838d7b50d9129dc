#include "draw_parameters.hpp"

namespace bodeflow::drive {

void describe_draw(Describe& d, EffectTable table, std::vector<std::string> effects) {
  std::string names;
  for (const EffectKind& kind : table) names += (names.empty() ? "" : ", ") + std::string(kind.name);
  d.parameter("effects", std::move(effects)).doc("those to draw from: " + names);
  d.parameter("outside", std::vector<std::string>{}).doc("those to draw from where something outside of the catalogue is hidden");
  d.parameter("odds", std::vector<double>{})
      .unit("1")
      .doc(
          "shares of none, one of effects, two of them, one of outside, with the sum 1; without them each of effects is as "
          "likely "
          "as the others");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the draw; without it the run's seed and the block's name do");
  for (const EffectKind& kind : table) {
    if (kind.least == 0) continue;
    d.parameter("size." + std::string(kind.name), std::vector<double>{kind.least, kind.greatest})
        .unit(kind.unit)
        .doc("smallest and largest " + std::string(kind.size_is));
  }
}

Draw read_draw(const Parameters& p, EffectTable table) {
  Draw draw{table, std::vector<SizeRange>(table.size(), SizeRange{0, 0}), p.texts("effects"), p.texts("outside"), {}};
  for (std::size_t k = 1; k < table.size(); ++k) {
    const std::string name = "size." + std::string(table[k].name);
    const std::vector<double>& range = p.numbers(name);
    if (range.size() != 2) fail(name + " has " + std::to_string(range.size()) + " values, allowed: two");
    draw.ranges[k] = {range[0], range[1]};
  }
  const std::vector<double>& odds = p.numbers("odds");
  if (!odds.empty() && odds.size() != 4) fail("odds has " + std::to_string(odds.size()) + " values, allowed: four, or none");
  if (!odds.empty()) draw.odds = Odds{odds[0], odds[1], odds[2], odds[3]};
  const auto effects = draw_effects(0, draw);
  if (!effects) fail(effects.error().text);
  return draw;
}

RecordBuilder bench_properties(const std::vector<HiddenEffect>& hidden) {
  std::vector<std::string> names, units;
  std::vector<double> sizes;
  std::string all;
  for (const HiddenEffect& effect : hidden) {
    names.emplace_back(effect.kind->name);
    units.emplace_back(effect.kind->unit);
    sizes.push_back(effect.size);
    all += (all.empty() ? "" : " and ") + names.back();
  }
  RecordBuilder r("bench_properties");
  r.set("effect", hidden.empty() ? "none" : all);
  r.set("size", hidden.empty() ? 0.0 : sizes[0]);
  r.set("unit", hidden.empty() ? "" : units[0]);
  r.set("effects", names).set("sizes", sizes).set("units", units);
  for (const HiddenEffect& effect : hidden) r.set(effect.kind->property, effect.size);
  return r;
}

}  // namespace bodeflow::drive
