#pragma once

#include <bodeflow/effect_proxy.hpp>
#include <bodeflow/parameter_text.hpp>
#include <exception>

namespace bodeflow::detail {

/// A base model of whatever plugin, configured. What it says of itself is asked once.
class BaseProxy final : public BaseModel {
 public:
  /// Takes over `c`; `model` may be null. Throws Failure with the model's words, or for one that is not complete.
  BaseProxy(const bf_base_model& c, const std::vector<StoredValue>& values, const bf_record* model) : part_(c) {
    const bool complete = c.struct_size >= sizeof c && c.configure && c.use_model && c.facts && c.parameters && c.places &&
                          c.known && c.inputs && c.response_unit && c.conventions && c.starts && c.state_space && c.response &&
                          c.react && c.destroy;
    if (!complete) fail("the plugin made a base model without all its functions");
    declare(values);
    if (model != nullptr) {
      Answer answer;
      answer.check(c.use_model(c.self, model, answer.c()));
    }
    read();
  }

  std::vector<FitParameter> parameters() const override { return parameters_; }
  std::vector<Place> places() const override { return places_; }
  std::vector<FitParameter> known() const override { return known_; }
  std::vector<PlantInput> inputs() const override { return inputs_; }
  double filter_hz() const override { return facts_.filter_hz; }
  Timing timing() const override { return {static_cast<Hold>(facts_.hold - BF_HOLD_ZERO_ORDER), facts_.delay_s}; }
  std::string response_unit() const override { return response_unit_; }
  std::vector<std::string> conventions() const override { return conventions_; }
  bool has_state_space() const override { return (facts_.flags & BF_BASE_STATE_SPACE) != 0; }
  bool has_laws() const override { return (facts_.flags & BF_BASE_LAWS) != 0; }

  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override {
    std::vector<bf_measured_response> list;
    for (const MeasuredResponse& m : measured) list.push_back(borrowed(m));
    std::vector<const bf_measured_response*> places;
    for (const auto& m : list) places.push_back(&m);
    Answer answer;
    answer.check(c().starts(c().self, places.data(), static_cast<std::uint32_t>(places.size()), answer.c()));
    return std::move(answer.values);
  }

  bool state_space(const double* v, const double* known, LinearPlant& plant) const override {
    bf_linear_plant p{};
    p.struct_size = sizeof p;
    p.context = &plant;
    p.resize = resize;
    if (c().state_space(c().self, v, known, &p) == 0) return false;
    if (p.inputs != static_cast<int>(inputs_.size()) || p.places != static_cast<int>(places_.size())) {
      fail("the base model states " + std::to_string(inputs_.size()) + " inputs and " + std::to_string(places_.size()) +
           " places, but gives a plant with " + std::to_string(p.inputs) + " and " + std::to_string(p.places));
    }
    return true;
  }
  bool response(const double* v, const double* known, std::complex<double> s, std::complex<double>* matrix) const override {
    return c().response(c().self, v, known, s.real(), s.imag(), reinterpret_cast<double*>(matrix)) != 0;
  }
  Reaction react(const double* v, const double* known, std::size_t place, const Signals& s) const override {
    Reaction r;
    c().react(c().self, v, known, place, borrowed(s), borrowed(r));
    return r;
  }

 private:
  const bf_base_model& c() const { return part_.c; }

  void declare(const std::vector<StoredValue>& values) {
    std::vector<BorrowedValue> borrowed;
    std::vector<bf_parameter_value> list;
    borrowed.reserve(values.size());
    for (const StoredValue& value : values) list.push_back(borrowed.emplace_back(value).c());
    Answer answer;
    answer.check(c().configure(c().self, list.data(), static_cast<std::uint32_t>(list.size()), answer.c()));
  }

  template <class Function>
  void ask(Function function, Answer& answer) {
    answer.check(function(c().self, answer.c()));
  }

  void read() {
    Answer parameters, places, known, inputs, unit, conventions, facts;
    ask(c().parameters, parameters);
    ask(c().places, places);
    ask(c().known, known);
    ask(c().inputs, inputs);
    ask(c().response_unit, unit);
    ask(c().conventions, conventions);
    facts_ = {sizeof facts_, 0, BF_HOLD_BAND_LIMITED, 0, 0.0, 0.0};
    facts.check(c().facts(c().self, &facts_, facts.c()));
    if (facts_.hold < BF_HOLD_ZERO_ORDER || facts_.hold > BF_HOLD_BAND_LIMITED) fail("the base model states an unknown hold");
    parameters_ = std::move(parameters.parameters);
    places_ = std::move(places.places);
    known_ = std::move(known.parameters);
    inputs_ = std::move(inputs.inputs);
    if (!unit.texts.empty()) response_unit_ = std::move(unit.texts.front());
    conventions_ = std::move(conventions.texts);
  }

  static std::int32_t resize(bf_linear_plant* p, std::int32_t states, std::int32_t inputs, std::int32_t places) noexcept {
    try {
      if (states < 0 || inputs < 0 || places < 0) return BF_FAILED;
      LinearPlant& plant = *static_cast<LinearPlant*>(p->context);
      plant.resize(states, inputs, places);
      p->states = states;
      p->inputs = inputs;
      p->places = places;
      p->A = plant.A.data(), p->B = plant.B.data(), p->E = plant.E.data();
      p->Cf = plant.Cf.data(), p->Df = plant.Df.data(), p->Ff = plant.Ff.data();
      p->Cs = plant.Cs.data(), p->Ds = plant.Ds.data(), p->Fs = plant.Fs.data();
      p->C = plant.C.data(), p->D = plant.D.data(), p->F = plant.F.data();
      return BF_OK;
    } catch (const std::exception&) {  // more than there is memory
      return BF_FAILED;
    }
  }

  OwnedPart<bf_base_model> part_;
  std::vector<FitParameter> parameters_, known_;
  std::vector<Place> places_;
  std::vector<PlantInput> inputs_;
  std::string response_unit_;
  std::vector<std::string> conventions_;
  bf_base_facts facts_{};
};

}  // namespace bodeflow::detail
