#include "estimator_block.hpp"

#include <algorithm>
#include <numbers>

#include "block_settings.hpp"
#include "design_advice.hpp"
#include "numbers_in_text.hpp"
#include "plan_record.hpp"
#include "records/response.hpp"

namespace bodeflow::adaptive_control {

void Estimator::describe(Describe& d) {
  d.id("adaptive_control.estimator")
      .summary("Estimates points of a plant's frequency response while it is controlled, one in each of several narrow bands.")
      .cost_ns(200);
  d.doc(
      "Input and output of the plant pass the same narrow band-pass filter for each frequency; a model of three parameters, "
      "y_f(t) = -a1 y_f(t-1) - a2 y_f(t-2) + b1 u_f(t-d-1), is fitted by recursive least squares in each band and evaluated at "
      "its centre. After about 30 samples of a step command the estimates are within 1.5 %; with two parameters they are biased "
      "by several per cent. The estimate of sample n uses u up to n - 1, so the block can stand in a feedback loop; `u` must be "
      "what really reaches the plant: the limited signal. Signals should have the size 1, or input_scale and output_scale say "
      "their size. Safety nets: a band whose excitation is below excitation.share of the control signal's swing is not updated; "
      "the covariance keeps its initial bound; residuals beyond 3 sigma count as 3 sigma. Each tells in `log` when it begins and "
      "ends.");
  d.reference("P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992, chapters 4 to 6");
  d.reference("G. J. Bierman, Factorization Methods for Discrete Sequential Estimation, 1977");
  describe_frequencies(d);
  d.parameter("delays", std::vector<std::int64_t>{0})
      .doc(
          "d, one for all frequencies or one each: samples at which the plant's step response is nearly 0, less one where the "
          "plant is of low order with a true delay");
  d.parameter("denominator", std::int64_t{2}).range(0, 2).doc("parameters a of the model");
  d.parameter("numerator", std::int64_t{1}).range(1, 3).doc("parameters b of the model");
  d.parameter("method", "least_squares")
      .choices({"least_squares", "directional", "extended", "instrumental"})
      .doc(
          "directional forgetting is biased on narrow bands; extended least squares model the noise by noise_terms; instrumental "
          "variables need `reference` and halve the bias of strong noise");
  d.parameter("noise_terms", std::int64_t{2}).range(1, 3).doc("of extended least squares");
  d.parameter("p0", 1e6).above(0).doc("P(0) = (w h)^2 p0 I; 1e4 with noise of some per cent");
  d.parameter("forgetting", 1.0).above(0).range(0, 1).doc("lambda; 0.98 to 1, about 2 / (1 - lambda) samples are remembered");
  d.parameter("filter.radius", 0.9).range(0.5, 0.999).doc("of the poles: the impulse response decays as radius^n");
  d.parameter("filter.sections", std::int64_t{2}).range(1, 8).doc("of order 2");
  d.parameter("filter.spread", 0.03490658503988659).unit("rad").range(0, 1).doc("angle between neighbouring poles");
  d.parameter("warm_up", std::int64_t{30}).range(0, 1e9).doc("updates before an estimate is handed on; 0 until then");
  d.parameter("input_scale", 1.0).unit("").above(0).doc("size of u");
  d.parameter("output_scale", 1.0).unit("").above(0).doc("size of y");
  d.parameter("excitation.share", 0.02).range(0, 1).doc("least excitation of a band over half the control signal's swing");
  d.parameter("excitation.floor", 0.0).range(0, 1e300).doc("least mean square of a filtered control signal, in scaled units");
  d.parameter("nets.gate", true).doc("no update without excitation");
  d.parameter("nets.bound", true).doc("of the covariance");
  d.parameter("nets.huber", true).doc("clips residuals");
  d.stream_in(y).doc("output of the plant");
  d.stream_in(u).doc("limited control signal");
  d.stream_in(reference).optional().doc("command, for instrumental variables");
  d.stream_out(response).doc("one complex channel a frequency; 0 where there is no estimate yet");
  d.message_in(plan)
      .optional()
      .record_type("adaptive_plan")
      .doc("frequencies and delays from a start-up experiment, before the first sample");
  d.message_out(result).record_type("frequency_response").doc("the last estimates with their variance, at the end");
  d.message_out(log).record_type("net_action").doc("a safety net begins or ceases to act");
}

void Estimator::configure(const Parameters& p) {
  BankSettings& s = settings_;
  s.omega = p.numbers("frequencies");
  for (const std::int64_t delay : p.integers("delays")) {
    if (delay < 0 || delay > kMostDelay) {
      fail("delays: " + std::to_string(delay) + " samples; allowed: 0 to " + std::to_string(kMostDelay));
    }
    s.delays.push_back(static_cast<int>(delay));
  }
  s.point.denominator = static_cast<int>(p.integer("denominator"));
  s.point.numerator = static_cast<int>(p.integer("numerator"));
  const std::string method = p.text("method");
  s.point.method = method == "directional"    ? Method::directional
                   : method == "extended"     ? Method::extended
                   : method == "instrumental" ? Method::instrumental
                                              : Method::least_squares;
  s.point.noise_terms = static_cast<int>(p.integer("noise_terms"));
  s.point.p0 = p.number("p0");
  s.point.forgetting = p.number("forgetting");
  s.point.filter_radius = p.number("filter.radius");
  s.point.filter_sections = static_cast<int>(p.integer("filter.sections"));
  s.point.filter_spread = p.number("filter.spread");
  s.point.warm_up = static_cast<int>(p.integer("warm_up"));
  s.point.gate = p.boolean("nets.gate");
  s.point.bound = p.boolean("nets.bound");
  s.point.huber = p.boolean("nets.huber");
  s.input_scale = p.number("input_scale");
  s.output_scale = p.number("output_scale");
  s.excitation_share = p.number("excitation.share");
  s.excitation_floor = p.number("excitation.floor");
}

void Estimator::resolve(Facts& f) {
  f.delay(u, 1);
  const StreamFacts& known = f.in(y).known ? f.in(y) : f.in(u);
  if (!known.known) return;
  if (known.channels != 1) fail("one channel is needed at each input, found: " + std::to_string(known.channels));
  BankSettings s = settings_;
  s.point.sample_time = 1.0 / known.rate.hz();
  value_or_fail(EstimatorBank::make(s));
  StreamFacts& g = f.out(response);
  g.known = true;
  g.channels = static_cast<int>(settings_.omega.size());
  g.rate = known.rate;
  g.length = known.length;
  g.clock = known.clock;
  g.notes["fit.frequencies"] = settings_.omega;
  if (settings_.point.method == Method::instrumental && f.in(y).known && f.in(u).known && !f.in(reference).known) {
    fail("instrumental variables need the command at 'reference'");
  }
}

void Estimator::advise(const Facts&, Advice& a) {
  const DesignAdvice advice = forgetting_advice(settings_.point.forgetting);
  for (const std::string& text : advice.notes) a.tell(text);
  for (const std::string& text : advice.warnings) a.warn(text);
}

void Estimator::activate(const Activation& a) {
  sample_time_ = 1.0 / a.rate.hz();
  settings_.point.sample_time = sample_time_;
  reset();
}

void Estimator::reset() {
  bank_ = value_or_fail(EstimatorBank::make(settings_));
  planned_ = settings_;
}

void Estimator::receive(int, const RecordView& record, Io& io) {
  if (io.position() > 0) fail("a plan arrived at sample " + std::to_string(io.position()) + "; allowed: before the first sample");
  const Plan found = read_plan(record, settings_.omega.size());
  planned_ = settings_;
  planned_.omega = found.omega;
  planned_.delays = {found.delay};
  bank_ = value_or_fail(EstimatorBank::make(planned_));
}

void Estimator::process(Io& io) {
  const auto y_in = io.read(y), u_in = io.read(u);
  const bool commanded = io.connected(reference);
  const auto r_in = commanded ? io.read(reference) : y_in;
  require_finite(y_in, "y", io.position());
  require_finite(u_in, "u", io.position());
  for (std::size_t n = 0; n < io.count(); ++n) {
    bank_->step(y_in[n], u_in[n], commanded ? r_in[n] : 0.0);
    for (int j = 0; j < bank_->points(); ++j) io.write(response, j)[n] = bank_->response()[j];
    NetLog& events = bank_->log();
    for (std::size_t i = 0; i < events.count(); ++i) io.emit(log, record_of(events[i], planned_.omega), n + 1);
    events.clear();
  }
}

void Estimator::finish(Io& io) {
  std::vector<std::size_t> order(planned_.omega.size());
  for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return planned_.omega[a] < planned_.omega[b]; });
  records::ResponseData data;
  data.form = "known_input";
  data.method = "adaptive_control.estimator";
  data.input_names = {"u"};
  data.output_names = {"y"};
  data.response_units = {""};
  data.sample_rate_hz = 1.0 / sample_time_;
  const auto lines = static_cast<Eigen::Index>(order.size());
  data.frequency_hz.resize(lines);
  data.response.resize(lines, 1);
  data.variance.resize(lines, 1);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const std::size_t j = order[static_cast<std::size_t>(k)];
    data.frequency_hz[k] = planned_.omega[j] / (2.0 * std::numbers::pi);
    data.response(k, 0) = bank_->response()[j];
    data.variance(k, 0) = bank_->variance(static_cast<int>(j));
    if (bank_->response()[j] == 0.0)
      data.warnings.push_back("no estimate at " + text_of(planned_.omega[j]) + " rad/s: too few updates");
  }
  io.emit(result, records::write_response(data));
}

}  // namespace bodeflow::adaptive_control
