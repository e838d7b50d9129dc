#include <bodeflow/describe.hpp>
#include <memory>

#include "bases/second_order.hpp"
#include "blocks/remedy_block.hpp"
#include "catch.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/delay.hpp"
#include "plugins/block_driver.hpp"
#include "plugins/spectrum/record_bytes.hpp"
#include "trace/told_model.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using bodeflow::test::AlignedRecord;
using bodeflow::test::BlockDriver;
using bodeflow::test::failure_of;
using Texts = std::vector<std::string>;

namespace {

/// A trace that names a delay and a friction.
RecordBuilder told() {
  RecordBuilder r("trace");
  r.set("verdict", "named").set("unit", "m").set("base", "residual.second_order").set("declarations", Texts{});
  r.set("parameter_names", Texts{"mass", "damping", "stiffness"});
  r.set("effects", Texts{"delay", "coulomb_friction"}).set("effect_places", Texts{"", "bearing"});
  r.set("effect_parameter_counts", std::vector<std::int64_t>{1, 1});
  r.set("effect_parameter_names", Texts{"delay", "coulomb_friction"}).set("effect_parameter_units", Texts{"s", "N"});
  const auto put = [&r](const char* name, std::initializer_list<double> values) {
    std::copy(values.begin(), values.end(), r.array<double>(name, "", {values.size()}).begin());
  };
  put("parameters_before", {1, 2, 3});
  put("parameters_after", {1.5, 2.5, 3.5});
  put("effect_parameters", {2e-4, 0.3});
  return r;
}

template <class E>
CatalogueEntry entry() {
  CatalogueEntry e;
  DescribeEffect describe(e.what);
  E::describe(describe);
  e.effect = std::make_shared<E>();
  return e;
}

PartsInReach parts() {
  return {[](const std::string&, const Texts&) { return std::make_shared<SecondOrder>(); },
          [](const std::string& name) { return name == "delay" ? entry<Delay>() : entry<CoulombFriction>(); }};
}

std::vector<double> list(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

}  // namespace

TEST_CASE("remedy: the found parameter times a factor, where the effect was named at that place") {
  const ToldModel t = read_told_model(AlignedRecord(told()).view());
  CHECK(remedy_value(kRemedies[0], t.effects, 1.0, "") == 2e-4);
  CHECK(remedy_value(kRemedies[3], t.effects, 2.0, "bearing") == 0.6);
  CHECK_FALSE(remedy_value(kRemedies[3], t.effects, 1.0, "load_bearing"));
  CHECK_FALSE(remedy_value(kRemedies[1], t.effects, 1.0, ""));
}

TEST_CASE("remedy: nobody sends commands later for a delay below zero") {
  const std::vector<NamedEffect> effects{{"delay", "", {"delay"}, {-1e-4}}, {"offset", "", {"offset"}, {-0.2}}};
  CHECK_FALSE(remedy_value(kRemedies[0], effects, 1.0, ""));
  CHECK(remedy_value(kRemedies[2], effects, 1.0, "") == -0.2);
}

TEST_CASE("remedy: an offset of the input is taken off the measurement behind the plant's steady gain") {
  const std::vector<NamedEffect> input{{"input_offset", "", {"input_offset"}, {0.3}}};
  const auto found = remedied(kRemedies[2], input, 1.0, "", -2.0);
  REQUIRE(found);
  CHECK(found->effect == "input_offset");
  CHECK(found->value == Approx(-0.6));
  CHECK_FALSE(remedied(kRemedies[2], input, 1.0, "", std::numeric_limits<double>::infinity()));
  CHECK_FALSE(remedied(kRemedies[2], input, 1.0, "", std::numeric_limits<double>::quiet_NaN()));
  CHECK_FALSE(remedied(kRemedies[0], input, 1.0, "", 1.0));
  const std::vector<NamedEffect> both{input[0], {"offset", "", {"offset"}, {-0.2}}};
  CHECK(remedied(kRemedies[2], both, 1.0, "", -2.0)->effect == "offset");
}

TEST_CASE("told model: built again without the effects that were remedied, with the parameters found beside them") {
  const ToldModel t = read_told_model(AlignedRecord(told()).view());
  const RebuiltModel all = rebuild(t, parts(), {});
  CHECK(all.model.additions.size() == 2);
  CHECK(list(all.values) == std::vector<double>{1.5, 2.5, 3.5, 2e-4, 0.3});
  CHECK(all.model.delay_s(all.values) == 2e-4);
  const RebuiltModel without = rebuild(t, parts(), {0});
  REQUIRE(without.model.additions.size() == 1);
  CHECK(without.model.additions[0].name() == "coulomb_friction");
  CHECK(without.model.additions[0].place == 0);
  CHECK(list(without.values) == std::vector<double>{1.5, 2.5, 3.5, 0.3});
  CHECK(list(rebuild(t, parts(), {0, 1}).values) == std::vector<double>{1.5, 2.5, 3.5});
}

TEST_CASE("told model: a trace that does not fit itself or the parts is refused by name") {
  const auto refusal = [](RecordBuilder r) {
    return failure_of([&] { rebuild(read_told_model(AlignedRecord(r).view()), parts(), {}); });
  };
  CHECK(refusal(told().set("effect_places", Texts{"", "gear"})) ==
        "the base model has no place 'gear', of which the trace tells");
  CHECK(refusal(told().set("effect_parameter_counts", std::vector<std::int64_t>{1, 2})) ==
        "the trace has fewer parameters of effects than effect_parameter_counts says");
  CHECK(refusal(told().set("effect_parameter_counts", std::vector<std::int64_t>{1})) ==
        "the trace has 2 effects, and effect_places and effect_parameter_counts do not fit them");
  CHECK(refusal(told().set("effect_parameter_counts", std::vector<std::int64_t>{2, 0})) ==
        "effect 'delay' has 1 parameters, the trace 2");
  CHECK(refusal(RecordBuilder("trace")) == "the trace has no text 'verdict'");
}

TEST_CASE("remedy block: one change for each thing that a drive can do, and whether there is any") {
  BlockDriver<RemedyBlock> block;
  block.set("can", Texts{"coulomb_friction", "offset"}).set("friction.unit", "N");
  block.configure();
  block.activate(1, Rate());
  block.receive(told(), 0);
  const auto& records = block.records();
  REQUIRE(records.size() == 5);
  const auto change = [&](std::size_t n, const char* parameter, double value) {
    const RecordView r(*records[n]);
    CHECK(r.type() == "parameter_change");
    CHECK(r.text("parameter") == parameter);
    CHECK(r.number("value") == value);
  };
  change(0, "lead", 0.0);  // the delay is named, and this drive can do nothing against it
  change(1, "compensation_time", 0.0);
  change(2, "correction", 0.0);
  change(3, "torque", 0.3);
  const RecordView remedy(*records[4]);
  CHECK(remedy.boolean("exists") == true);
  CHECK(remedy.text("sentence") == "Switched on in the drive: friction feed-forward of 0.3 N.");

  BlockDriver<RemedyBlock> none;
  none.configure();
  none.activate(1, Rate());
  none.receive(told(), 0);
  CHECK(RecordView(*none.records()[4]).boolean("exists") == false);
  BlockDriver<RemedyBlock> wrong;
  wrong.set("can", Texts{"hum"});
  CHECK(failure_of([&] { wrong.configure(); }) ==
        "can: no remedy for 'hum', allowed: delay, dead_time, offset, coulomb_friction");
}
