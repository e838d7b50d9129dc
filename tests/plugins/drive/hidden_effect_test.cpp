#include <cmath>
#include <map>

#include "catch.hpp"
#include "drive/hidden_axis_effect_block.hpp"
#include "drive/hidden_effect_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using test::BlockDriver;
using test::failure_of;
using Texts = std::vector<std::string>;

namespace {

constexpr std::uint64_t kDraws = 4000;

Draw draw_of(Texts effects) {
  Draw draw{kDriveEffects, {}, std::move(effects), {}, {}};
  for (const EffectKind& kind : kDriveEffects) draw.ranges.push_back({kind.least, kind.greatest});
  return draw;
}

std::string words(const std::vector<HiddenEffect>& hidden) {
  std::string text;
  for (const HiddenEffect& effect : hidden) text += (text.empty() ? "" : "+") + std::string(effect.kind->name);
  return text.empty() ? "none" : text;
}

/// The record that the block sends.
RecordView secret(BlockDriver<HiddenEffectBlock>& block) {
  block.configure();
  block.resolve({});
  block.activate(1, Rate());
  block.finish();
  REQUIRE(block.records().size() == 1);
  return RecordView(*block.records()[0]);
}

Texts names(const RecordView& record) {
  Texts all;
  for (const AttributeView a : record.attributes()) all.emplace_back(a.name());
  return all;
}

}  // namespace

TEST_CASE("hidden effect: each of the list is as likely as the others, whatever its place") {
  const Texts list{"saturation", "none", "hum", "dead_time"};
  std::map<std::string, double> counts;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) counts[words(draw_effects(seed, draw_of(list)).value())] += 1;
  CHECK(counts.size() == 4);
  // Four standard deviations of a binomial count with p = 1/4.
  for (const auto& [name, count] : counts) CHECK(std::abs(count - kDraws / 4.0) < 4 * std::sqrt(kDraws * 3.0 / 16));
}

TEST_CASE("hidden effect: sizes are log-uniform within their range") {
  Draw draw = draw_of({"delay"});
  draw.ranges[1] = {1e-5, 1e-3};
  double sum = 0, squares = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const HiddenEffect drawn = draw_effects(seed, draw).value()[0];
    REQUIRE(drawn.size >= 1e-5);
    REQUIRE(drawn.size <= 1e-3);
    const double place = std::log10(drawn.size) + 4;  // -1 .. 1
    sum += place;
    squares += place * place;
  }
  const double root = std::sqrt(static_cast<double>(kDraws));
  CHECK(std::abs(sum / kDraws) < 4 / std::sqrt(3.0) / root);
  CHECK(std::abs(squares / kDraws - 1.0 / 3) < 4 * std::sqrt(4.0 / 45) / root);
}

TEST_CASE("hidden effect: the motor's parameters spread within their bounds and stay those of a motor") {
  const MotorParameters nominal{6.6, 5.5, 0.475, 0.475, 0.454};
  double least = 1, greatest = 1;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const MotorParameters m = draw_motor(seed, nominal, 0.08).value();
    for (const auto& [value, centre] : {std::pair{m.rs, 6.6}, {m.rr, 5.5}, {m.ls, 0.475}, {m.lr, 0.475}, {m.lm, 0.454}}) {
      REQUIRE(std::abs(value / centre - 1) <= 0.08);
    }
    REQUIRE(m.lm * m.lm < m.ls * m.lr);
    least = std::min(least, m.rs / 6.6);
    greatest = std::max(greatest, m.rs / 6.6);
  }
  CHECK(least < 0.921);
  CHECK(greatest > 1.079);
}

TEST_CASE("hidden effect: the record has the effect's own property and no other") {
  for (const EffectKind& kind : kDriveEffects) {
    INFO(kind.name);
    BlockDriver<HiddenEffectBlock> block;
    block.set("effects", Texts{kind.name}).set("seed", std::int64_t{3});
    const RecordView record = secret(block);
    CHECK(record.type() == "bench_properties");
    CHECK(record.text("effect") == kind.name);
    CHECK(record.text("unit") == kind.unit);
    if (kind.least == 0) {
      CHECK(names(record) == Texts{"effect", "size", "unit", "effects", "sizes", "units"});
      CHECK(record.number("size") == 0.0);
      continue;
    }
    CHECK(names(record).size() == 7);
    CHECK(record.number(kind.property) == record.number("size"));
    CHECK(*record.number("size") >= kind.least);
    CHECK(*record.number("size") <= kind.greatest);
  }
}

TEST_CASE("hidden effect: the same seed gives the same secret, and a spread leaves the effect as it is") {
  const auto drawn = [](std::int64_t seed, double spread) {
    BlockDriver<HiddenEffectBlock> block;
    block.set("seed", seed).set("parameter_spread", spread);
    const RecordView record = secret(block);
    return std::tuple(std::string(*record.text("effect")), *record.number("size"), record.number("lm"));
  };
  CHECK(drawn(11, 0.08) == drawn(11, 0.08));
  CHECK(drawn(11, 0.08) != drawn(12, 0.08));
  CHECK(std::get<0>(drawn(11, 0)) == std::get<0>(drawn(11, 0.08)));
  CHECK(std::get<1>(drawn(11, 0)) == std::get<1>(drawn(11, 0.08)));
  CHECK_FALSE(std::get<2>(drawn(11, 0)));
  CHECK(std::get<2>(drawn(11, 0.08)));
}

TEST_CASE("hidden effect: what cannot be drawn is refused by name") {
  const auto refusal = [](auto&& give) {
    BlockDriver<HiddenEffectBlock> block;
    give(block);
    return failure_of([&] { block.configure(); });
  };
  const std::string all =
      "none, delay, dead_time, saturation, skin_effect, iron_loss, resistance_drift, sensor_lag, offset, hum, loose_contact, "
      "rectifying_contact, gain_wobble, link_ripple";
  CHECK(refusal([](auto& b) {
          b.set("effects", Texts{"none", "friction"});
        }) == "effects: unknown effect 'friction', allowed: " + all);
  CHECK(refusal([](auto& b) { b.set("effects", Texts{}); }) == "effects is empty, allowed: one or more of " + all);
  CHECK(refusal([](auto& b) { b.set("size.delay", std::vector<double>{1e-3}); }) == "size.delay has 1 values, allowed: two");
  CHECK(refusal([](auto& b) {
          b.set("size.saturation", std::vector<double>{2, 1});
        }) == "size.saturation is from 2 to 1, allowed: two values above 0, the first not above the second");
  CHECK(refusal([](auto& b) { b.set("lm", 0.48); }) != "no failure");
}

TEST_CASE("hidden effect: odds say how often nothing, one, two or something outside is hidden") {
  Draw draw = draw_of({"delay", "sensor_lag", "dead_time", "offset", "none"});
  draw.outside = {"loose_contact", "link_ripple"};
  draw.odds = Odds{0.2, 0.5, 0.1, 0.2};
  std::map<std::string, double> counts;
  double none = 0, one = 0, two = 0, outside = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const auto hidden = draw_effects(seed, draw).value();
    counts[words(hidden)] += 1;
    const bool is_outside = hidden.size() == 1 && (words(hidden) == "loose_contact" || words(hidden) == "link_ripple");
    (hidden.empty() ? none : is_outside ? outside : hidden.size() == 1 ? one : two) += 1;
    if (hidden.size() == 2) REQUIRE(hidden[0].kind->likeness != hidden[1].kind->likeness);
  }
  for (const auto& [count, p] : {std::pair{none, 0.2}, {one, 0.5}, {two, 0.1}, {outside, 0.2}})
    CHECK(std::abs(count - kDraws * p) < 4 * std::sqrt(kDraws * p * (1 - p)));
  CHECK(counts["delay+sensor_lag"] + counts["sensor_lag+delay"] == 0);
  CHECK(counts["delay+dead_time"] > 0);
  CHECK(counts["offset+sensor_lag"] > 0);
}

TEST_CASE("hidden effect: odds that can't be drawn are refused by name") {
  const auto refusal = [](Draw draw, Odds odds) {
    draw.odds = odds;
    const auto drawn = draw_effects(0, draw);
    return drawn ? std::string() : drawn.error().text;
  };
  CHECK(refusal(draw_of({"delay"}), {0.5, 0.6, 0, 0}) == "odds are 0.5, 0.6, 0, 0, allowed: four shares from 0 that add up to 1");
  CHECK(refusal(draw_of({"none"}), {0.5, 0.5, 0, 0}) == "odds ask for an effect, and effects names none");
  CHECK(refusal(draw_of({"delay", "sensor_lag"}), {0, 0, 1, 0}) ==
        "odds ask for two effects, and effects has no two that do not act alike");
  CHECK(refusal(draw_of({"delay"}), {0, 0, 0, 1}) == "odds ask for an effect outside, and outside names none");
  CHECK(refusal(draw_of({"none"}), {1, 0, 0, 0}).empty());
}

TEST_CASE("hidden effect: two effects stand in the record with the properties of both") {
  BlockDriver<HiddenEffectBlock> block;
  block.set("effects", Texts{"dead_time", "hum"}).set("odds", std::vector<double>{0, 0, 1, 0}).set("seed", std::int64_t{5});
  const RecordView record = secret(block);
  CHECK(record.texts("effects")->size() == 2);
  CHECK((record.text("effect") == "dead_time and hum" || record.text("effect") == "hum and dead_time"));
  CHECK(record.number("dead_time"));
  CHECK(record.number("current_hum"));
}

TEST_CASE("hidden axis effect: the record has the property and the true parameters near the nominal ones") {
  BlockDriver<HiddenAxisEffect> block;
  block.set("effects", Texts{"backlash"}).set("parameter_spread", 0.1);
  block.configure();
  block.resolve({});
  block.activate(3, Rate());
  block.finish();
  const RecordView record(*block.records().at(0));
  CHECK(*record.number("backlash") >= 1e-3);
  CHECK(*record.number("backlash") <= 6e-3);
  CHECK(*record.number("stiffness") == Approx(40).epsilon(0.1));
  CHECK(*record.number("stiffness") != 40);
  CHECK(*record.number("load_inertia") == Approx(2e-3).epsilon(0.1));
}
