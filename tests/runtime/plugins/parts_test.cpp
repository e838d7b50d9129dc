// What blocks get of the effects and base models of all plugins: through the SDK, over the C border.
#include <dlfcn.h>

#include <bodeflow/record.hpp>
#include <cmath>

#include "catch.hpp"
#include "runtime/plugins/shelf.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

std::filesystem::path fixture(const std::string& name) { return std::filesystem::path(BODEFLOW_FIXTURES) / (name + ".so"); }

std::vector<std::filesystem::path> fixtures(const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files;
  for (const auto& name : names) files.push_back(fixture(name));
  return files;
}

Situation full_situation() {
  Situation s;
  s.input_unit = "V", s.output_unit = "A";
  s.sample_time_s = 0.001, s.duration_s = 2.0, s.input_peak = 3.0, s.input_rms = 4.0, s.output_peak = 5.0, s.output_rms = 6.0;
  s.residual_mean = -7.0, s.residual_rms = 8.0;
  s.place.name = "rail", s.place.kind = "bearing", s.place.flow_unit = "m/s", s.place.stored_unit = "m";
  s.place.reaction_unit = "N", s.place.coefficient = 9.0, s.place.flow = 10.0, s.place.stored = 11.0, s.place.effort = 12.0;
  s.line_hz = {1.0, 2.0};
  s.response = {{1.0, -1.0}, {2.0, -2.0}};
  s.missing = {{0.5, 0.25}};
  s.missing_std = {0.125};
  s.peaks_hz = {50.0, 100.0};
  s.jumps_s = {0.75};
  return s;
}

}  // namespace

TEST_CASE("the effects of all plugins are listed by their ids, with all that they say of themselves") {
  const Shelf shelf(fixtures({"parts", "good", "only_effect"}));
  CHECK(shelf.refused.empty());
  const auto effects = shelf.parts().effects();
  REQUIRE(effects.size() == 4);
  CHECK(effects[0].id == "lone.offset");
  CHECK(effects[2].id == "parts.gain");
  CHECK(effects[3].id == "parts.lag");
  CHECK(effects[3].acts == Acts::series);
  CHECK(effects[2].memoryless_linear);
  const EffectDescription& d = effects[1];
  CHECK(d.id == "parts.drag");
  CHECK(d.name() == "drag");
  CHECK(d.summary == "Force against the velocity.");
  CHECK(d.doc == "F = c v, and a count of the steps.");
  CHECK(d.references == "Somebody, A book, 1901\nSomebody else, 1902");
  CHECK(d.acts == Acts::law);
  CHECK(d.kinds == std::vector<std::string>{"bearing", "spring"});
  CHECK(d.memory == 2);
  CHECK(d.steps_per_sample == 4);
  CHECK(d.rough);
  CHECK(d.nonstationary);
  CHECK_FALSE(d.memoryless_linear);
  CHECK(d.equivalents == std::vector<std::string>{"gain", "lag"});
  CHECK(d.separation == "a second level");
}

TEST_CASE("base models are listed with what can be declared") {
  const Shelf shelf(fixtures({"parts"}));
  const auto models = shelf.parts().base_models();
  REQUIRE(models.size() == 1);
  CHECK(models[0].id == "parts.mass");
  CHECK(models[0].summary == "A mass on a damper.");
  CHECK(models[0].references == "Newton, 1687");
  REQUIRE(models[0].parameters.size() == 4);
  CHECK(models[0].parameters[0].required);
  CHECK(models[0].parameters[0].unit == "Hz");
  CHECK(models[0].parameters[1].choices == std::vector<std::string>{"zero_order", "first_order"});
  CHECK(models[0].parameters[1].fallback.strings.at(0) == "zero_order");
}

TEST_CASE("a plugin is loaded when the first of its parts is made, not before") {
  const auto loaded = [] {
    void* library = dlopen(fixture("only_effect").c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (library != nullptr) dlclose(library);
    return library != nullptr;
  };
  const Shelf shelf(fixtures({"parts", "only_effect"}));
  CHECK(shelf.parts().effects().size() == 4);
  CHECK_FALSE(loaded());
  const auto offset = shelf.parts().effect("lone.offset");
  CHECK(loaded());
  const double by = 0.5;
  CHECK(offset->map(&by, 2.0, 0.0, nullptr) == 2.5);
}

TEST_CASE("an effect sees its whole situation across the border, and gives parameters, starts and words") {
  const Shelf shelf(fixtures({"parts"}));
  const auto drag = shelf.parts().effect("parts.drag");
  Situation s = full_situation();
  CHECK(drag->refuses(s).empty());
  const auto parameters = drag->parameters(s);
  REQUIRE(parameters.size() == 2);
  CHECK(parameters[0].name == "c");
  CHECK(parameters[0].unit == "N");
  CHECK(parameters[0].doc == "drag");
  CHECK(parameters[0].logarithmic);
  CHECK(parameters[0].low == 0.0);
  CHECK(std::isinf(parameters[0].high));
  CHECK_FALSE(parameters[1].logarithmic);
  CHECK(parameters[1].each_record);
  CHECK(parameters[1].low == -1.0);
  CHECK(parameters[1].high == 2.0);
  CHECK(parameters[1].scale == 2.5);
  CHECK(drag->starts(s) == std::vector<std::vector<double>>{{9.0, 0.0}, {1.0, 0.5}});
  const std::vector<double> value{1.0, 2.0}, deviation{3.0};
  CHECK(drag->sentence(value, deviation, s) ==
        "3 V A 0.001 2 3 4 5 6 -7 8 rail bearing m/s m N 9 10 11 12 l1 l2 r1,-1 r2,-2 m0.5,0.25 s0.125 p50 p100 j0.75");
  s.place.name = "wall";
  CHECK(drag->refuses(s) == "a wall does not move");
}

TEST_CASE("laws, maps, transfers, delays and tones give the same numbers across the border") {
  const Shelf shelf(fixtures({"parts"}));
  const auto drag = shelf.parts().effect("parts.drag");
  const double p[] = {2.0, 0.0}, memory[] = {5.0, 0.0};
  double next[] = {0.0, 0.0};
  Signals s;
  s.flow = 3.0, s.stored = 10.0, s.time_s = 100.0, s.step_s = 1000.0, s.gain = 0.25;
  const Reaction r = drag->react(p, s, memory, next);
  CHECK(r.value == 1116.0);
  CHECK(r.by_flow == 2.0);
  CHECK(r.by_stored == 1.0);
  CHECK(next[0] == 6.0);
  CHECK(next[1] == 0.25);
  double counted = 0.0;
  CHECK(shelf.parts().effect("parts.gain")->map(p, 10.0, 0.5, &counted) == 21.5);
  CHECK(counted == 1.0);
  const auto lag = shelf.parts().effect("parts.lag");
  CHECK(lag->transfer(p, {0.0, 2.0}) == 1.0 / std::complex<double>(1.0, 1.0));
  CHECK(lag->delay_s(p) == 4.0);
  CHECK(lag->tones_hz(p) == std::vector<double>{2.0, 4.0});
  CHECK(shelf.log.empty());
}

TEST_CASE("an effect that throws gives no number and is told once, whatever it throws") {
  const Shelf shelf(fixtures({"parts"}));
  const auto drag = shelf.parts().effect("parts.drag");
  const double p[] = {2.0, 0.0}, memory[] = {0.0, 0.0};
  double next[2];
  Signals bad;
  bad.flow = 13.0;
  for (int i = 0; i < 3; ++i) CHECK(std::isnan(drag->react(p, bad, memory, next).value));
  CHECK(shelf.log == std::vector<std::string>{"2 effect 'parts.drag': react failed and gives no number: thirteen (told once)"});
  const auto gain = shelf.parts().effect("parts.gain");
  double counted = 0.0;
  CHECK(std::isnan(gain->map(p, 101.0, 0.0, &counted)));
  REQUIRE(shelf.log.size() == 2);
  CHECK(
      shelf.log[1] ==
      "2 effect 'parts.gain': map failed and gives no number: an exception that is not derived from std::exception (told once)");
  const auto lag = shelf.parts().effect("parts.lag");
  CHECK(std::isnan(lag->transfer(p, 0.0).imag()));
  const double early = -1.0;
  CHECK(std::isnan(lag->delay_s(&early)));
  CHECK(shelf.log.size() == 3);
  CHECK(failure_of([&] { (void)gain->parameters({}); }) == "no parameters today");
  CHECK(failure_of([&] { (void)gain->starts({}); }) == "an exception that is not derived from std::exception");
  CHECK(failure_of([&] { (void)gain->sentence({}, {}, {}); }) == "no words");
  CHECK(gain->map(p, 1.0, 0.0, &counted) == 3.0);
}

TEST_CASE("a base model takes declared values with units and gives them across the border") {
  const Shelf shelf(fixtures({"parts"}));
  const auto mass = shelf.parts().base_model("parts.mass", {"fc = 2 kHz", "hold=first_order", "lengths=[1 mm, 2]"});
  CHECK(mass->filter_hz() == 2000.0);
  CHECK(mass->timing().hold == Hold::first_order);
  CHECK(mass->timing().delay_s == 0.25);
  CHECK(mass->response_unit() == "m/N");
  CHECK(mass->conventions() == std::vector<std::string>{"rods: 2", "model: none"});
  REQUIRE(mass->parameters().size() == 2);
  CHECK(mass->parameters()[1].name == "damping");
  REQUIRE(mass->places().size() == 1);
  CHECK(mass->places()[0].kind == "bearing");
  CHECK(mass->places()[0].reaction_unit == "N");
  CHECK(mass->known().at(0).name == "added_mass");
  REQUIRE(mass->inputs().size() == 1);
  CHECK(mass->inputs()[0].channel == 1);
  CHECK(mass->inputs()[0].derivative == 2);
  CHECK(mass->has_state_space());
  CHECK(mass->has_laws());
  MeasuredResponse measured;
  measured.frequency_hz = {1.0, 2.0};
  measured.response = {{3.0, 4.0}, {5.0, 6.0}};
  measured.weight = {7.0, 8.0};
  measured.known = {9.0};
  const std::vector<MeasuredResponse> two{{}, measured};
  CHECK(mass->starts(two) == std::vector<std::vector<double>>{{1.0, 6.0}, {7.0, 9.0}});
  CHECK(failure_of([&] { (void)mass->starts({}); }) == "no response");
}

TEST_CASE("plants, responses and laws of a base model pass the border") {
  const Shelf shelf(fixtures({"parts"}));
  const auto mass = shelf.parts().base_model("parts.mass", {"corner=1"});
  const double v[] = {4.0, 2.0}, known[] = {6.0};
  LinearPlant plant;
  REQUIRE(mass->state_space(v, known, plant));
  CHECK(plant.states == 1);
  CHECK(plant.A == std::vector<double>{-0.2});
  CHECK(plant.B == std::vector<double>{0.1});
  CHECK(plant.E == std::vector<double>{-0.1});
  CHECK(plant.Fs == std::vector<double>{0.0});
  std::complex<double> matrix[4];
  REQUIRE(mass->response(v, known, {0.0, 1.0}, matrix));
  CHECK(std::abs(matrix[0] * std::complex<double>(2.0, 10.0) - 1.0) < 1e-15);
  CHECK(matrix[3] == -matrix[0]);
  Signals s;
  s.flow = 5.0;
  const Reaction r = mass->react(v, known, 3, s);
  CHECK(r.value == 16.0);
  CHECK(r.by_stored == 3.0);
  const double outside[] = {-1.0, 1.0}, throws[] = {13.0, 1.0}, small[] = {3.0, 1.0}, wide[] = {2.0, 1.0};
  CHECK_FALSE(mass->state_space(outside, known, plant));
  CHECK_FALSE(mass->response(outside, known, 1.0, matrix));
  CHECK(shelf.log.empty());
  CHECK_FALSE(mass->state_space(throws, known, plant));
  CHECK(shelf.log == std::vector<std::string>{
                         "2 base model 'parts.mass': state_space failed and gives no number: thirteen kilogrammes (told once)"});
  CHECK_FALSE(mass->state_space(small, known, plant));
  CHECK(failure_of([&] { (void)mass->state_space(wide, known, plant); }) ==
        "the base model states 1 inputs and 1 places, but gives a plant with 2 and 1");
}

TEST_CASE("a black box is handed the record of its model") {
  const Shelf shelf(fixtures({"parts"}));
  RecordBuilder model("transfer_function");
  const auto bytes = model.bytes();
  const auto made = shelf.parts().base_model("parts.mass", {"corner=1"}, RecordView(bytes.data()));
  CHECK(made->conventions().at(1) == "model: transfer_function");
}

TEST_CASE("a wrong declaration is refused with what is allowed and what was meant") {
  const Shelf shelf(fixtures({"parts"}));
  const auto why = [&](const std::vector<std::string>& declarations) {
    return failure_of([&] { (void)shelf.parts().base_model("parts.mass", declarations); });
  };
  const std::string mass = "base model 'parts.mass'";
  CHECK(why({}) == mass + " needs 'corner'; declare corner=...");
  CHECK(why({"corner"}) == mass + ": 'corner' has not the form name=value");
  CHECK(why({"conrer=1"}) == mass + " declares no 'conrer' (did you mean 'corner'?); it declares: corner, hold, order, lengths");
  CHECK(why({"corner=1", "fc=2"}) == mass + ": corner: stands twice");
  CHECK(why({"corner=0"}) == mass + ": corner: found 0, allowed: above 0 and below 1000000");
  CHECK(why({"corner=inf"}) == mass + ": corner: found inf, allowed: a finite number");
  CHECK(why({"corner=1 s"}) == mass + ": corner: 1 s is a time; allowed: a frequency in Hz");
  CHECK(why({"corner=1", "order=5"}) == mass + ": order: found 5, allowed: at least 1 and at most 4");
  CHECK(why({"corner=1", "order=1.5"}) == mass + ": order: '1.5' is not an integer");
  CHECK(why({"corner=1", "hold=zero"}) == mass + ": hold: found 'zero', allowed: zero_order, first_order");
  CHECK(why({"corner=1", "hold=zero_ordr"}) ==
        mass + ": hold: found 'zero_ordr', allowed: zero_order, first_order (did you mean 'zero_order'?)");
  CHECK(why({"corner=13"}) == "a corner of 13 Hz brings bad luck");
}

TEST_CASE("an id that no plugin gives is refused with the nearest one") {
  const Shelf shelf(fixtures({"parts"}));
  CHECK(failure_of([&] { (void)shelf.parts().effect("parts.darg"); }) ==
        "no plugin gives the effect 'parts.darg' (did you mean 'parts.drag'?)");
  CHECK(failure_of([&] { (void)shelf.parts().effect("lag"); }) == "no plugin gives the effect 'lag' (did you mean 'parts.lag'?)");
  CHECK(failure_of([&] { (void)shelf.parts().base_model("parts.drag"); }) == "no plugin gives the base model 'parts.drag'");
}

TEST_CASE("a host without parts has none") {
  bf_host host{};
  host.extension = [](const bf_host*, const char*) -> const void* { return nullptr; };
  const Parts parts(host);
  CHECK(parts.effects().empty());
  CHECK(parts.base_models().empty());
  CHECK(failure_of([&] { (void)parts.effect("parts.drag"); }) == "no plugin gives the effect 'parts.drag'");
}

TEST_CASE("a part without its functions, or one that its plugin refuses, is refused in its turn") {
  const Shelf incomplete(fixtures({"part_base"}));
  CHECK(failure_of([&] { (void)incomplete.parts().base_model("broken.part"); }) ==
        "the plugin made a base model without all its functions");
  const Shelf empty(fixtures({"part_plain"}));
  CHECK(failure_of([&] { (void)empty.parts().effect("broken.part"); }) == "the plugin made an effect without all its functions");
  const Shelf refuses(fixtures({"part_refuses"}));
  CHECK_THROWS_AS(refuses.parts().effect("broken.part"), Services::HostRefused);
}

TEST_CASE("every field of situations, parameters, places, signals and plants crosses the border") {
  // Of another size: a field was added. It needs its place in abi.h and part_values.hpp, and here.
  CHECK(sizeof(Signals) == 5 * sizeof(double));
  CHECK(sizeof(Reaction) == 3 * sizeof(double));
  CHECK(sizeof(FitParameter) == 3 * sizeof(std::string) + 5 * sizeof(double));
  CHECK(sizeof(Place) == 5 * sizeof(std::string) + 4 * sizeof(double));
  CHECK(sizeof(MeasuredResponse) == 4 * sizeof(std::vector<double>));
  CHECK(sizeof(Situation) == 2 * sizeof(std::string) + 8 * sizeof(double) + sizeof(Place) + 6 * sizeof(std::vector<double>));
  CHECK(sizeof(LinearPlant) == 4 * sizeof(int) + 12 * sizeof(std::vector<double>));
  CHECK(sizeof(PlantInput) == 2 * sizeof(int));
  CHECK(sizeof(Timing) == 2 * sizeof(double));
}
