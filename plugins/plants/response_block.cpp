#include "response_block.hpp"

#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>

#include "model_parameters.hpp"
#include "records/response.hpp"
#include "records/signals.hpp"

namespace bodeflow::plants {
namespace {

using Complex = std::complex<double>;

Complex complex_normal(numerics::Random& random) {
  const double re = random.normal();
  return std::sqrt(0.5) * Complex(re, random.normal());
}

}  // namespace

void ResponseBlock::describe(Describe& d) {
  d.id("plants.response").summary("The frequency response of a known model, with noise of a stated size.").role("source");
  d.doc(
      "What an instrument that sweeps would give: the response at stated frequencies, plus complex normal noise whose variance "
      "stands in the record. `noise.absolute` is a share of the largest |G| of each output and input. `scatter` is one complex "
      "relative error of the whole response, as from leads that are connected anew; the record does not know of it.");
  d.message_in(model).record_type("model").doc("with a state space, or numerator and denominator");
  d.message_out(out).record_type("frequency_response").doc("at the end");
  d.required<double>("first").unit("Hz").range(0, 1e15).doc("lowest frequency");
  d.required<double>("last").unit("Hz").range(0, 1e15).doc("highest frequency");
  d.parameter("count", std::int64_t{400}).range(2, 1000000).doc("lines");
  d.parameter("spacing", "logarithmic").choices({"logarithmic", "linear"}).doc("of the lines");
  d.parameter("noise.relative", 0.0).unit("1").range(0, 10).doc("standard deviation of the complex value over |G|");
  d.parameter("noise.absolute", 0.0).unit("1").range(0, 10).doc("the same over the largest |G|");
  d.parameter("scatter", 0.0).unit("1").range(0, 10).doc("standard deviation of one relative error of all lines");
  d.parameter("variance", true).doc("state the variance of the noise in the record");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the noise; without it the run's seed and the block's name do");
}

void ResponseBlock::configure(const Parameters& p) {
  const double first = p.number("first"), last = p.number("last");
  const bool logarithmic = p.text("spacing") == "logarithmic";
  if (!(last > first)) fail("last must be above first");
  if (logarithmic && !(first > 0.0)) fail("first must be above 0 Hz for logarithmic spacing");
  const Eigen::Index count = p.integer("count");
  frequency_hz_.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    frequency_hz_[k] = logarithmic ? first * std::pow(last / first, part) : first + part * (last - first);
  }
  relative_ = p.number("noise.relative");
  absolute_ = p.number("noise.absolute");
  scatter_ = p.number("scatter");
  state_variance_ = p.boolean("variance");
  own_seed_ = p.has("seed");
  seed_ = own_seed_ ? static_cast<std::uint64_t>(p.integer("seed")) : 0;
}

void ResponseBlock::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
}

void ResponseBlock::receive(int, const RecordView& record, Io&) {
  auto read = records::read_linear_model(record);
  if (!read) fail(read.error().text);
  model_ = std::move(*read);
}

void ResponseBlock::finish(Io& io) {
  if (!model_) fail("no model arrived");
  auto system = records::state_space_of(*model_);
  if (!system) fail(system.error().text);
  const double nyquist = system->sample_time > 0.0 ? 0.5 / system->sample_time : INFINITY;
  if (frequency_hz_[frequency_hz_.size() - 1] > nyquist * (1.0 + 1e-9))
    fail("last is above half the sample rate of the model, " + records::short_number(nyquist) + " Hz");
  const auto exact = numerics::frequency_response(*system, frequency_hz_);
  records::ResponseData r;
  r.form = "known_input";
  r.method = "plants.response";
  const bool several = model_->inputs.names.size() > 1 || model_->outputs.names.size() > 1;
  r.input_names = several ? model_->inputs.names : std::vector{model_->input_name};
  r.output_names = several ? model_->outputs.names : std::vector{model_->output_name};
  r.response_units = records::response_units(several ? model_->outputs.units : std::vector{model_->output_unit},
                                             several ? model_->inputs.units : std::vector{model_->input_unit});
  if (model_->sample_time_s > 0.0) r.sample_rate_hz = 1.0 / model_->sample_time_s;
  r.frequency_hz = frequency_hz_;
  const Eigen::Index lines = frequency_hz_.size(), inputs = system->inputs(), entries = inputs * system->outputs();
  r.response.resize(lines, entries);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Complex late = std::polar(1.0, -2.0 * std::numbers::pi * frequency_hz_[k] * model_->delay_s);
    for (Eigen::Index e = 0; e < entries; ++e)
      r.response(k, e) = exact[static_cast<std::size_t>(k)](e / inputs, e % inputs) * late;
  }
  if (!r.response.allFinite()) fail("the response is not finite at a line: a pole lies on it");
  const Eigen::RowVectorXd floor = absolute_ * r.response.cwiseAbs().colwise().maxCoeff();
  Eigen::MatrixXd variance = (relative_ * r.response.cwiseAbs()).array().square().matrix();
  variance.rowwise() += floor.array().square().matrix();
  for (Eigen::Index e = 0; e < entries; ++e) {
    numerics::Random random = numerics::Random::stream(seed_, static_cast<std::uint64_t>(e));
    const Complex all = 1.0 + scatter_ * complex_normal(random);
    for (Eigen::Index k = 0; k < lines; ++k)
      r.response(k, e) = all * r.response(k, e) + std::sqrt(variance(k, e)) * complex_normal(random);
  }
  if (state_variance_ && (relative_ > 0.0 || absolute_ > 0.0)) r.variance = std::move(variance);
  io.emit(out, records::write_response(r));
}

void ResponseBlock::reset() { model_.reset(); }

}  // namespace bodeflow::plants
