// Built with clang and libc++, to be loaded by a host that was built with g++ and libstdc++: everything that passes the border.
#include <bodeflow/block.hpp>
#include <bodeflow/parts.hpp>
#include <bodeflow/record.hpp>
#include <complex>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

class Echo final : public bodeflow::Block {
 public:
  static constexpr bodeflow::In<double> in{0, "in"};
  static constexpr bodeflow::Out<double> out{0, "out"};
  static constexpr bodeflow::MessageIn question{0, "question"};
  static constexpr bodeflow::MessageOut answer{0, "answer"};

  static void describe(bodeflow::Describe& d) {
    d.id("foreign.echo").summary("Answers in a library of its own.");
    d.stream_in(in);
    d.stream_out(out).same_as(in);
    d.message_in(question).record_type("question");
    d.message_out(answer).record_type("answer");
    d.parameter("words", std::vector<std::string>{"one", "two"});
    d.parameter("scale", 2.0).range(0.0, 10.0);
    d.parameter("poles", std::vector<std::complex<double>>{{-1.0, 2.0}});
  }
  void configure(const bodeflow::Parameters& p) override {
    words_ = p.texts("words");
    scale_ = p.number("scale");
    for (const auto& word : words_) ++counts_[word];
    log_info("built with " BODEFLOW_BUILD);
  }
  void process(bodeflow::Io& io) override {
    for (int c = 0; c < io.channels(in); ++c) {
      auto x = io.read(in, c);
      auto y = io.write(out, c);
      for (std::size_t n = 0; n < x.size(); ++n) {
        if (x[n] == 13.0) explode();
        if (x[n] == 14.0) bodeflow::fail("fourteen is not allowed");
        y[n] = scale_ * x[n];
      }
    }
  }
  void receive(int, const bodeflow::RecordView& record, bodeflow::Io& io) override {
    bodeflow::RecordBuilder r("answer");
    r.set("to", std::string(record.text("text").value_or("nothing")));
    r.set("words", static_cast<std::int64_t>(counts_.size()));
    const auto asked = record.array("values");
    auto values = r.array<double>("values", "V", {asked ? asked->as<double>().size() : 0});
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = scale_ * asked->as<double>()[i];
    io.emit(answer, r);
  }

 private:
  /// Through the library's own exceptions, streams and a handler on the way, which must be found in this library.
  static void explode() {
    try {
      (void)std::map<int, int>().at(1);
    } catch (const std::out_of_range&) {
      std::ostringstream text;
      text << "thirteen brings bad luck (" << 13 << ")";
      throw std::runtime_error(text.str());
    }
  }

  std::vector<std::string> words_;
  std::map<std::string, int> counts_;
  double scale_ = 1.0;
};

class Drag final : public bodeflow::Effect {
 public:
  static void describe(bodeflow::DescribeEffect& d) {
    d.id("foreign.drag").summary("Brakes in a library of its own.").acts(bodeflow::Acts::law, {"bearing"}).memory(1);
  }
  std::vector<bodeflow::FitParameter> parameters(const bodeflow::Situation& s) const override {
    return {bodeflow::positive("drag", s.place.reaction_unit + "/(" + s.place.flow_unit + ")")};
  }
  std::vector<std::vector<double>> starts(const bodeflow::Situation& s) const override {
    if (s.line_hz.empty()) explode();
    return {{std::abs(s.missing.at(0))}, std::vector<double>(s.line_hz)};
  }
  std::string sentence(std::span<const double> value, std::span<const double>, const bodeflow::Situation& s) const override {
    std::ostringstream text;
    text << "drag of " << value[0] << " at the " << s.place.name;
    return text.str();
  }
  bodeflow::Reaction react(const double* p, const bodeflow::Signals& s, const double* memory, double* next) const override {
    if (s.flow == 13.0) explode();
    next[0] = memory[0] + s.step_s;
    return {p[0] * s.flow, p[0], 0.0};
  }

 private:
  static void explode() {
    std::ostringstream text;
    text << "thirteen again (" << 13 << ")";
    throw std::runtime_error(text.str());
  }
};

class Cart final : public bodeflow::BaseModel {
 public:
  static void describe(bodeflow::Describe& d) {
    d.id("foreign.cart").summary("A cart in a library of its own.");
    d.parameter("rails", std::vector<std::string>{"left", "right"}).doc("names of places");
    d.parameter("delay", 0.0).unit("s").doc("of the command");
  }
  void configure(const bodeflow::Parameters& p) override {
    rails_ = p.texts("rails");
    delay_s_ = p.number("delay");
  }
  std::vector<bodeflow::FitParameter> parameters() const override { return {bodeflow::positive("mass", "kg")}; }
  std::vector<bodeflow::Place> places() const override {
    std::vector<bodeflow::Place> places(rails_.size());
    for (std::size_t i = 0; i < rails_.size(); ++i) places[i].name = rails_[i], places[i].kind = "bearing";
    return places;
  }
  bodeflow::Timing timing() const override { return {bodeflow::Hold::zero_order, delay_s_}; }
  std::vector<std::vector<double>> starts(std::span<const bodeflow::MeasuredResponse> measured) const override {
    return {std::vector<double>(measured.front().frequency_hz)};
  }
  bool state_space(const double* v, const double*, bodeflow::LinearPlant& p) const override {
    p.resize(1, 1, static_cast<int>(rails_.size()));
    p.B = {1.0 / v[0]};
    for (double& e : p.E) e = -1.0 / v[0];
    for (double& c : p.Cf) c = 1.0;
    p.C = {1.0};
    return true;
  }

 private:
  std::vector<std::string> rails_;
  double delay_s_ = 0.0;
};

}  // namespace

BODEFLOW_PLUGIN("foreign", "3.2.1", Echo, Drag, Cart)
