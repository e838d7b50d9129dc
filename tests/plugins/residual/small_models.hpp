#pragma once

#include <bodeflow/base_model.hpp>
#include <bodeflow/effect.hpp>
#include <functional>
#include <memory>

#include "model/joint_model.hpp"

/// A mass on a spring and effects given by a lambda, for tests of the engine.
namespace bodeflow::residual::small {

/// m x'' + c x' + k x = u - reactions, y = x + through u; places: bearing (flow x') and spring (stored x).
struct Mass final : BaseModel {
  Timing declared;
  double through = 0.0;

  std::vector<FitParameter> parameters() const override {
    return {positive("mass", "kg"), positive("damping", "N*s/m"), positive("stiffness", "N/m")};
  }
  std::vector<Place> places() const override {
    Place bearing, spring;
    bearing.name = bearing.kind = "bearing";
    spring.name = spring.kind = "spring";
    return {bearing, spring};
  }
  Timing timing() const override { return declared; }
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {{1.0, 4.0, 4000.0}}; }
  bool state_space(const double* v, const double*, LinearPlant& p) const override {
    if (!(v[0] > 0.0)) return false;
    p.resize(2, 1, 2);
    p.A = {0.0, 1.0, -v[2] / v[0], -v[1] / v[0]};
    p.B = {0.0, 1.0 / v[0]};
    p.E = {0.0, 0.0, -1.0 / v[0], -1.0 / v[0]};
    p.Cf = {0.0, 1.0, 0.0, 1.0};
    p.Cs = {1.0, 0.0, 1.0, 0.0};
    p.C = {1.0, 0.0};
    p.D = {through};
    return true;
  }
};

/// An effect whose hooks are lambdas.
struct Made final : Effect {
  std::vector<FitParameter> own;
  std::function<Reaction(const double*, const Signals&, const double*, double*)> law;
  std::function<std::complex<double>(const double*, std::complex<double>)> passes;
  std::function<double(const double*, double, double, double*)> maps;
  std::function<double(const double*)> delays;
  std::function<std::vector<double>(const double*)> tones;

  std::vector<FitParameter> parameters(const Situation&) const override { return own; }
  std::vector<std::vector<double>> starts(const Situation&) const override { return {std::vector<double>(own.size(), 1.0)}; }
  std::string sentence(std::span<const double>, std::span<const double>, const Situation&) const override { return "made"; }
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override {
    return law(p, s, memory, next);
  }
  std::complex<double> transfer(const double* p, std::complex<double> s) const override { return passes(p, s); }
  double map(const double* p, double x, double t, double* memory) const override { return maps(p, x, t, memory); }
  double delay_s(const double* p) const override { return delays(p); }
  std::vector<double> tones_hz(const double* p) const override { return tones(p); }
};

/// An addition with `count` parameters, to be completed.
inline std::pair<Addition, std::shared_ptr<Made>> made(Acts acts, std::size_t count, std::size_t place = Addition::kNoPlace) {
  auto effect = std::make_shared<Made>();
  for (std::size_t i = 0; i < count; ++i) effect->own.push_back(real("p" + std::to_string(i), "1", 1.0));
  Addition a;
  a.what.id = "test.made";
  a.what.acts = acts;
  a.effect = effect;
  a.place = place;
  a.parameters = effect->own;
  a.label = "made";
  return {a, effect};
}

}  // namespace bodeflow::residual::small
