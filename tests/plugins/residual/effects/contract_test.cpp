#include <algorithm>
#include <bodeflow/unit_parse.hpp>
#include <cmath>
#include <set>

#include "all_effects.hpp"
#include "catch.hpp"
#include "effects/mains.hpp"

using namespace bodeflow;
using namespace bodeflow::residual::testing;

namespace {

/// One situation a kind of place, one in all for effects that have none.
std::vector<Situation> situations(const Tried& t) {
  std::vector<Situation> all;
  for (const std::string& kind : t.what.kinds) all.push_back(situation(kind));
  return all.empty() ? std::vector<Situation>{situation("bearing")} : all;
}

/// Signals of a movement that turns around, stops and is shaken.
Signals movement(int n, double gain) {
  Signals s;
  s.step_s = 1e-3;
  s.time_s = n * s.step_s;
  s.flow = 2.0 * std::sin(40.0 * s.time_s) + 0.5 * std::sin(333.0 * s.time_s);
  s.stored = 0.05 - 2.0 / 40.0 * std::cos(40.0 * s.time_s) - 0.5 / 333.0 * std::cos(333.0 * s.time_s);
  if (n % 200 < 20) s.flow = 0.0;
  s.gain = gain;
  return s;
}

}  // namespace

TEST_CASE("effects: ids are unique and in the family, texts are there, laws know their places") {
  std::set<std::string> ids;
  for (const Tried& t : laws_maps_and_tones()) {
    INFO(t.what.id);
    CHECK(ids.insert(t.what.id).second);
    CHECK(t.what.id.rfind("residual.", 0) == 0);
    CHECK(t.what.summary.size() > 20);
    CHECK(t.what.doc.size() > 10);
    CHECK((t.what.acts == Acts::law) == !t.what.kinds.empty());
  }
}

TEST_CASE("effects: starts lie within the bounds, have a value for each parameter, and units that can be read") {
  for (const Tried& t : laws_maps_and_tones()) {
    for (const Situation& s : situations(t)) {
      INFO(t.what.id);
      const auto parameters = t.effect->parameters(s);
      const auto starts = t.effect->starts(s);
      CHECK(starts.size() >= 1);
      CHECK(starts.size() <= 3);
      for (const FitParameter& p : parameters) {
        INFO(p.name << " [" << p.unit << "]");
        CHECK(parse_unit(p.unit));
        CHECK_FALSE(p.doc.empty());
        CHECK(p.scale > 0.0);
      }
      for (const auto& start : starts) {
        REQUIRE(start.size() == parameters.size());
        for (std::size_t i = 0; i < start.size(); ++i) {
          CHECK(std::isfinite(start[i]));
          CHECK(start[i] >= parameters[i].low);
          CHECK(start[i] <= parameters[i].high);
          CHECK((!parameters[i].logarithmic || start[i] > 0.0));
        }
      }
    }
  }
}

TEST_CASE("effects: starts are finite and allowed where nothing is known of the place") {
  for (const Tried& t : laws_maps_and_tones()) {
    INFO(t.what.id);
    const Situation nothing;
    const auto parameters = t.effect->parameters(nothing);
    for (const auto& start : t.effect->starts(nothing)) {
      for (std::size_t i = 0; i < start.size(); ++i) {
        CHECK(std::isfinite(start[i]));
        CHECK((!parameters[i].logarithmic || start[i] > 0.0));
        CHECK(parameters[i].scale > 0.0);
      }
    }
  }
}

TEST_CASE("effects: sentences name value, deviation and place") {
  for (const Tried& t : laws_maps_and_tones()) {
    for (const Situation& s : situations(t)) {
      INFO(t.what.id);
      const std::vector<double> value = t.effect->starts(s)[0], std(value.size(), 0.0123);
      const std::string text = t.effect->sentence(value, std, s);
      INFO(text);
      CHECK(text.size() > 15);
      CHECK(text.find("nan") == std::string::npos);
      CHECK(text.find('_') == std::string::npos);
      CHECK(text.back() != '.');
    }
  }
}

TEST_CASE("laws: the same arguments give the same reaction, and nothing else is remembered") {
  for (const Tried& t : laws_maps_and_tones()) {
    if (t.what.acts != Acts::law) continue;
    INFO(t.what.id);
    const auto p = t.effect->starts(situation(t.what.kinds[0]))[0];
    std::vector<double> memory(t.what.memory, 0.0), next(t.what.memory, 0.0), again(t.what.memory, 7.0);
    for (int n = 0; n < 500; ++n) {
      const Signals s = movement(n, 1e-4);
      Signals other = s;
      other.flow += 1.0;
      other.stored -= 0.01;
      t.effect->react(p.data(), other, memory.data(), next.data());  // a trial that is thrown away
      const Reaction r = t.effect->react(p.data(), s, memory.data(), next.data());
      const Reaction same = t.effect->react(p.data(), s, memory.data(), again.data());
      REQUIRE(std::isfinite(r.value));
      REQUIRE(r.value == same.value);
      REQUIRE(r.by_flow == same.by_flow);
      REQUIRE(r.by_stored == same.by_stored);
      REQUIRE(next == again);
      memory = next;
    }
  }
}

TEST_CASE("laws: slopes are those of the reaction where it has no corner") {
  for (const Tried& t : laws_maps_and_tones()) {
    if (t.what.acts != Acts::law) continue;
    INFO(t.what.id);
    const auto p = t.effect->starts(situation(t.what.kinds[0])).back();
    std::vector<double> memory(t.what.memory, 0.0), next(t.what.memory, 0.0), trash(t.what.memory, 0.0);
    int right = 0, compared = 0;
    double greatest = 0.0;
    for (int n = 0; n < 600; ++n) {
      const Signals s = movement(n, 1e-3);
      const Reaction r = t.effect->react(p.data(), s, memory.data(), next.data());
      greatest = std::max(greatest, std::abs(r.value));
      for (const bool flow : {true, false}) {
        Signals up = s, down = s;
        const double h = 1e-6;
        (flow ? up.flow : up.stored) += h;
        (flow ? down.flow : down.stored) -= h;
        const double wanted = (t.effect->react(p.data(), up, memory.data(), trash.data()).value -
                               t.effect->react(p.data(), down, memory.data(), trash.data()).value) /
                              (2.0 * h);
        const double found = flow ? r.by_flow : r.by_stored;
        ++compared;
        right += std::abs(found - wanted) <= 1e-4 * std::abs(wanted) + 1e-6 * greatest;
      }
      memory = next;
    }
    // LuGre's slope is a near one (its limit is held); all others miss it at their corners alone.
    CHECK(right > (t.what.id == "residual.lugre_friction" ? 0.5 : 0.95) * compared);
  }
}

TEST_CASE("tones: hum is sought at tones of the mains alone, another tone everywhere else") {
  using namespace bodeflow::residual;
  CHECK(mains_of(50.2) == 50.2);
  CHECK(mains_of(149.4) == Approx(49.8));
  CHECK(mains_of(52.0) == 0.0);
  const auto all = laws_maps_and_tones();
  const auto find = [&](const std::string& id) {
    return *std::find_if(all.begin(), all.end(), [&](const Tried& t) { return t.what.id == id; });
  };
  const Tried hum = find("residual.hum"), tone = find("residual.interharmonic");
  Situation s;
  s.duration_s = 4.0;
  s.peaks_hz = {150.3, 33.7, 50.1, 60.0};
  CHECK(hum.effect->refuses(s).empty());
  CHECK(hum.effect->starts(s) == std::vector<std::vector<double>>{{150.3 / 3.0}, {60.0}});
  CHECK(tone.effect->starts(s) == std::vector<std::vector<double>>{{33.7}});
  s.peaks_hz = {33.7};
  CHECK(hum.effect->refuses(s) == "no tone between the lines near 50 or 60 Hz or three times that");
  s.peaks_hz = {50.0};
  CHECK(tone.effect->refuses(s) == "no tone between the lines beside those of the mains");
  const double p[] = {50.1};
  CHECK(hum.effect->tones_hz(p) == std::vector<double>{50.1, 3.0 * 50.1});
}
