#include "comparison_block.hpp"

#include <cmath>

#include "data_units.hpp"

namespace bodeflow::validation {

void ComparisonBlock::describe(Describe& d) {
  d.id("validation.comparison")
      .summary("Compares models with each other, and with measured data by simulation and prediction.")
      .cost_ns(5);
  d.doc(
      "Every record that arrives on `model` is a model of its own. Without streams: parameters with their deviations, poles and "
      "responses side by side, differences from the first model in standard deviations. With streams, beside that: simulation "
      "from the measured input (initial state and offset estimated; continuous models with their delay and the input held over "
      "each sample, or linear "
      "between samples where the model states `hold: none`), `steps`-step prediction with a noise model (an autoregression "
      "fitted to the simulation's residual of these "
      "data), fit = 100 (1 - |y - yhat| / |y - mean y|), correlations of the residual with itself and the input, FPE, AIC, and "
      "warnings where data leave the band or the amplitude that a model was fitted to. The fit is biased by noise on the "
      "measured "
      "input: the simulation of a right model then misses the output by G times that noise.");
  d.reference("L. Ljung, System Identification: Theory for the User, 2nd ed., 1999, chapters 3.2 and 16");
  d.stream_in(input).optional().doc("what excites the plant: one channel");
  d.stream_in(output).optional().doc("what the plant answers: one channel");
  d.message_in(model).record_type("model").doc("the models, from as many blocks as wished, in the order of their names");
  d.message_out(out).record_type("comparison");
  d.parameter("names", std::vector<std::string>{}).doc("what the models are called; default: by their methods");
  d.parameter("steps", std::int64_t{10}).range(1, 1e6).doc("samples ahead of the prediction");
  d.parameter("lags", std::int64_t{25}).range(1, 10000).doc("lags of the correlations, on each side");
  d.parameter("noise_order", std::int64_t{20})
      .range(0, 200)
      .doc("highest order of the noise model; 0: white noise, the prediction is the simulation");
  d.parameter("offset", true).doc("estimate a constant offset of the output beside the initial state");
  d.parameter("confidence", 0.99).unit("1").above(0.0).below(1.0).doc("of the bands of the correlations");
  d.parameter("shown", std::int64_t{500}).range(2, 1e6).doc("samples of measured, simulated and predicted output in the record");
  d.parameter("limit", std::int64_t{16'777'216}).range(16, 1e9).doc("most samples; about 100 bytes of memory each and model");
}

void ComparisonBlock::configure(const Parameters& p) {
  names_ = p.texts("names");
  settings_.steps = p.integer("steps");
  settings_.lags = p.integer("lags");
  settings_.noise_order = p.integer("noise_order");
  settings_.offset = p.boolean("offset");
  settings_.confidence = p.number("confidence");
  shown_ = p.integer("shown");
  limit_ = p.integer("limit");
}

void ComparisonBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (u.known != y.known) fail(std::string("only '") + (u.known ? "input" : "output") + "' is connected; needed: both, or none");
  has_data_ = u.known;
  if (!has_data_) return;
  for (const auto& [facts, port] : {std::pair{&u, "input"}, {&y, "output"}})
    if (facts->channels != 1)
      fail(std::string("'") + port + "' has " + std::to_string(facts->channels) +
           " channels; a comparison takes one input and one output");
  if (!u.rate.known()) fail("'input' has no sample rate");
  if (u.clock != y.clock)
    fail("'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock + "'; needed: one clock");
  sample_rate_hz_ = u.rate.hz();
  input_signal_ = records::signals_of(u, "input");
  output_signal_ = records::signals_of(y, "output");
}

void ComparisonBlock::collect(std::span<const double> samples, const char* port, const records::Signals& signal,
                              std::vector<double>& into) const {
  if (into.size() + samples.size() > static_cast<std::size_t>(limit_))
    fail("more than " + std::to_string(limit_) + " samples; compare over a part of the data, or raise limit");
  for (std::size_t n = 0; n < samples.size(); ++n)
    if (!std::isfinite(samples[n]))
      fail(std::string(port) + " '" + signal.names.front() + "': sample " + std::to_string(into.size() + n) + " is not finite");
  into.insert(into.end(), samples.begin(), samples.end());
}

void ComparisonBlock::process(Io& io) {
  if (!has_data_) return;
  collect(io.read(input, 0), "input", input_signal_, u_);
  collect(io.read(output, 0), "output", output_signal_, y_);
}

void ComparisonBlock::receive(int, const RecordView& record, Io&) {
  auto read = records::read_model(record);
  if (!read) fail("model " + std::to_string(models_.size() + 1) + ": " + read.error().text);
  models_.push_back(std::move(*read));
  holds_.push_back(record.text("hold") == "none" ? Hold::first_order : Hold::zero_order);
}

/// The model against the data; a name of another output is only a warning.
Expected<Judgement> ComparisonBlock::judged(std::size_t i, const Measured& data) const {
  const auto converted = in_units_of(input_signal_, output_signal_, models_[i]);
  if (!converted) return unexpected(converted.error().text);
  JudgementSettings settings = settings_;
  settings.hold = holds_[i];
  auto judgement = judge(*converted, data, settings);
  const std::string &own = converted->output_name, &found = output_signal_.names.front();
  if (judgement && !own.empty() && own != "output" && found != "output" && own != found)
    judgement->warnings.push_back("its output is '" + own + "', that of the data '" + found +
                                  "': see that both are the same quantity");
  return judgement;
}

/// Given, or by method, numbered where a name would stand twice.
std::vector<std::string> ComparisonBlock::names() const {
  if (!names_.empty() && names_.size() != models_.size())
    fail("names has " + std::to_string(names_.size()) + " for " +
         records::counted(static_cast<std::int64_t>(models_.size()), "model"));
  if (!names_.empty()) return names_;
  std::vector<std::string> made;
  for (const auto& m : models_) {
    const std::string base = m.method.empty() ? "model" : m.method;
    std::string name = base;
    for (int i = 2; std::find(made.begin(), made.end(), name) != made.end(); ++i) name = base + " " + std::to_string(i);
    made.push_back(std::move(name));
  }
  return made;
}

void ComparisonBlock::finish(Io& io) {
  if (models_.empty()) fail("no model arrived");
  auto comparison = compare_models(names(), models_);
  if (!comparison) fail(comparison.error().text);
  comparison->settings = settings_;
  comparison->shown = shown_;
  if (has_data_) {
    comparison->data = {sample_rate_hz_, Eigen::Map<const Eigen::VectorXd>(u_.data(), static_cast<Eigen::Index>(u_.size())),
                        Eigen::Map<const Eigen::VectorXd>(y_.data(), static_cast<Eigen::Index>(y_.size()))};
    comparison->input_signal = input_signal_;
    comparison->output_signal = output_signal_;
    comparison->holds = holds_;
    for (std::size_t i = 0; i < models_.size(); ++i) {
      auto judgement = judged(i, comparison->data);
      if (!judgement) fail("model '" + comparison->names[i] + "': " + judgement.error().text);
      comparison->judgements.push_back(std::move(*judgement));
    }
  }
  const RecordBuilder record = write_comparison(*comparison);
  io.emit(out, record);
  for (const std::string& warning : comparison->warnings) log_warning(warning);
  for (std::size_t i = 0; i < comparison->judgements.size(); ++i)
    for (const std::string& warning : comparison->judgements[i].warnings)
      log_warning("model '" + comparison->names[i] + "': " + warning);
}

void ComparisonBlock::reset() {
  u_.clear();
  y_.clear();
  models_.clear();
  holds_.clear();
}

}  // namespace bodeflow::validation
