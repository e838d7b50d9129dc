#include <cmath>
#include <map>

#include "catch.hpp"
#include "drive/hidden_effect_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using test::BlockDriver;
using test::failure_of;
using Texts = std::vector<std::string>;

namespace {

constexpr std::uint64_t kDraws = 4000;

std::array<SizeRange, kEffects.size()> default_ranges() {
  std::array<SizeRange, kEffects.size()> ranges{};
  for (std::size_t k = 0; k < kEffects.size(); ++k) ranges[k] = {kEffects[k].least, kEffects[k].greatest};
  return ranges;
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
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) counts[draw_effect(seed, list, default_ranges())->kind->name] += 1;
  CHECK(counts.size() == 4);
  // Four standard deviations of a binomial count with p = 1/4.
  for (const auto& [name, count] : counts) CHECK(std::abs(count - kDraws / 4.0) < 4 * std::sqrt(kDraws * 3.0 / 16));
}

TEST_CASE("hidden effect: sizes are log-uniform within their range") {
  auto ranges = default_ranges();
  ranges[1] = {1e-5, 1e-3};
  double sum = 0, squares = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const HiddenEffect drawn = draw_effect(seed, {"delay"}, ranges).value();
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
  for (const EffectKind& kind : kEffects) {
    INFO(kind.name);
    BlockDriver<HiddenEffectBlock> block;
    block.set("effects", Texts{kind.name}).set("seed", std::int64_t{3});
    const RecordView record = secret(block);
    CHECK(record.type() == "bench_properties");
    CHECK(record.text("effect") == kind.name);
    CHECK(record.text("unit") == kind.unit);
    if (kind.least == 0) {
      CHECK(names(record) == Texts{"effect", "size", "unit"});
      CHECK(record.number("size") == 0.0);
      continue;
    }
    CHECK(names(record) == Texts{"effect", "size", "unit", kind.property});
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
  const std::string all = "none, delay, dead_time, saturation, skin_effect, iron_loss, resistance_drift, sensor_lag, offset, hum";
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
