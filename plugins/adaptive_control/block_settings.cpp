#include "block_settings.hpp"

#include <cmath>

#include "numbers_in_text.hpp"
#include "pole_patterns.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr int kMostPoles = 20;

int whole(const Parameters& p, const char* name, int least, int most) {
  const std::int64_t value = p.integer(name);
  if (value < least || value > most) {
    fail(std::string(name) + " is " + std::to_string(value) + "; allowed: " + std::to_string(least) + " to " +
         std::to_string(most));
  }
  return static_cast<int>(value);
}

Eigen::VectorXd pattern(const Parameters& p, const std::string& group, int order, double omega) {
  const std::string kind = p.text((group + ".pattern").c_str());
  if (kind == "bessel") return bessel(order, omega);
  if (kind == "butterworth") return butterworth(order, omega, p.number((group + ".opening").c_str()));
  if (kind == "dominant") return dominant_poles(order, omega, p.number((group + ".ratio").c_str()));
  return real_poles(order, omega);
}

/// A given polynomial, monic.
Eigen::VectorXd given_polynomial(const Parameters& p, const std::string& name) {
  Eigen::VectorXd polynomial = vector_of(p.numbers(name.c_str()));
  if (polynomial.size() == 0 || !(polynomial[0] != 0.0) || !polynomial.allFinite()) {
    fail(name + ": needed: finite coefficients in descending powers of s, the first of them not 0");
  }
  return polynomial / polynomial[0];
}

void describe_poles(Describe& d, const std::string& group, const char* of) {
  const std::string default_pattern = group == "desired" ? "dominant" : "bessel";
  d.parameter(group + ".pattern", default_pattern)
      .choices({"bessel", "dominant", "butterworth", "real"})
      .doc(std::string("of ") + of + ": Bess(n, w); Bess(2, w) Bess(n - 2, ratio w); Butt(n, w, opening); (s + w)^n");
  d.parameter(group + ".ratio", 3.0).range(1, 100).doc("of dominant: how much faster the other poles are");
  d.parameter(group + ".opening", 0.78539816339744831)
      .unit("rad")
      .range(0, 1.57)
      .doc("of butterworth: half the angle that the poles are spread over");
  d.optional<std::vector<double>>(group + ".denominator")
      .doc(std::string(of) + " as coefficients in descending powers of s, in place of a pattern");
}

}  // namespace

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void describe_frequencies(Describe& d) {
  d.required<std::vector<double>>("frequencies")
      .unit("rad/s")
      .doc("of fitting (Omega): often up to where the plant has a phase of -180 degrees, spread over about a decade");
}

void describe_desired(Describe& d) {
  d.required<double>("desired.bandwidth").unit("rad/s").above(0).doc("w_m: distance of the slow poles of A_m from the origin");
  d.parameter("desired.order", std::int64_t{5}).range(1, kMostPoles).doc("degree of A_m: that of the plant where it is known");
  describe_poles(d, "desired", "A_m");
  d.parameter("desired.delay", 0.0)
      .unit("s")
      .range(0, 1e6)
      .doc("of the desired response; true delays of the plant belong into it");
  d.optional<double>("observer.bandwidth").unit("rad/s").above(0).doc("w_o, w_m otherwise: slower frees speed for the command");
  d.optional<std::int64_t>("observer.order").range(0, kMostOrder).doc("degree of A_o, that of R otherwise");
  describe_poles(d, "observer", "A_o");
}

DesiredResponse read_desired(const Parameters& p, int degree) {
  const double omega = p.number("desired.bandwidth");
  DesiredResponse desired;
  desired.a_m = p.has("desired.denominator") ? given_polynomial(p, "desired.denominator")
                                             : pattern(p, "desired", whole(p, "desired.order", 1, kMostPoles), omega);
  const double observer = p.has("observer.bandwidth") ? p.number("observer.bandwidth") : omega;
  const int order = p.has("observer.order") ? whole(p, "observer.order", 0, kMostOrder) : degree;
  desired.a_o =
      p.has("observer.denominator") ? given_polynomial(p, "observer.denominator") : pattern(p, "observer", order, observer);
  desired.delay_s = p.number("desired.delay");
  return desired;
}

void describe_structure(Describe& d) {
  d.parameter("degree", std::int64_t{2}).range(1, kMostOrder).doc("of R: the controller's order, prescribed factors included");
  d.optional<std::int64_t>("degree_s").range(0, kMostOrder).doc("of S, that of R otherwise; less delays the feedback");
  d.parameter("fixed_r", std::vector<double>{1.0, -1.0})
      .doc("factor of R in descending powers of z, monic: [1, -1] is integral action");
  d.parameter("fixed_s", std::vector<double>{1.0}).doc("factor of S in descending powers of z, monic");
  d.parameter("weights", std::vector<double>{}).doc("v, one a frequency; 1 where left out");
}

RstStructure read_structure(const Parameters& p) {
  RstStructure s;
  s.omega = p.numbers("frequencies");
  s.n_r = whole(p, "degree", 1, kMostOrder);
  s.n_s = p.has("degree_s") ? whole(p, "degree_s", 0, kMostOrder) : s.n_r;
  s.r_p = vector_of(p.numbers("fixed_r"));
  s.s_p = vector_of(p.numbers("fixed_s"));
  s.weights = p.numbers("weights");
  return s;
}

void describe_plant(Describe& d, bool required) {
  if (required) {
    d.required<std::vector<double>>("plant.numerator").doc("of the plant in s, descending powers");
    d.required<std::vector<double>>("plant.denominator").doc("of the plant in s, descending powers");
  } else {
    d.optional<std::vector<double>>("plant.numerator").doc("of a known plant in s, descending powers");
    d.optional<std::vector<double>>("plant.denominator").doc("of a known plant in s, descending powers");
  }
  d.parameter("plant.delay", 0.0).unit("s").range(0, 1e6).doc("of the plant");
}

bool has_plant(const Parameters& p) { return p.has("plant.numerator") && p.has("plant.denominator"); }

numerics::TransferFunction read_plant(const Parameters& p) {
  return {vector_of(p.numbers("plant.numerator")), vector_of(p.numbers("plant.denominator")), 0.0};
}

void require_finite(std::span<const double> values, const char* port, std::uint64_t position) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!std::isfinite(values[n])) fail(std::string("'") + port + "' is not finite at sample " + std::to_string(position + n));
  }
}

namespace {

const char* words_of(Departure departure) {
  switch (departure) {
    case Departure::none:
      return "";
    case Departure::output:
      return "the output left its range";
    case Departure::error:
      return "the mean error is as large as if nothing were controlled";
    case Departure::limits:
      return "the control signal keeps running into its limits while the command rests";
  }
  return "";
}

}  // namespace

RecordBuilder record_of(const NetEvent& event, const std::vector<double>& omega) {
  std::string cause;
  switch (event.net) {
    case Net::excitation:
      cause = "the band's excitation is below its least value: no update";
      break;
    case Net::covariance:
      cause = "the covariance would grow beyond its initial value";
      break;
    case Net::huber:
      cause = "the residual is beyond 3 sigma: it counts as 3 sigma";
      break;
    case Net::ladder:
      cause = std::string("the demands were lowered: ") + words_of(event.refusal);
      break;
    case Net::kept:
      cause = std::string("no demands were met, the last controller stays: ") + words_of(event.refusal);
      break;
    case Net::rate:
      cause = "the new controller is far from the one in use: it is approached step by step";
      break;
    case Net::retreat:
      cause = std::string(words_of(event.departure)) + ": back to the proportional controller, then lower demands";
      break;
  }
  RecordBuilder r("net_action");
  r.set("net", std::string(name_of(event.net)));
  r.set("action", std::string(event.begins ? "begins" : "ends"));
  r.set("sample", event.sample);
  r.set("cause", cause);
  if (event.band >= 0) r.set("frequency", omega[static_cast<std::size_t>(event.band)]);
  if (event.net == Net::ladder) {
    r.set("step", static_cast<std::int64_t>(event.value));
  } else if (event.limit > 0.0) {
    r.set("value", event.value);
    r.set("limit", event.limit);
  }
  return r;
}

}  // namespace bodeflow::adaptive_control
