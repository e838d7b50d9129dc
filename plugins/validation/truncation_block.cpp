#include "truncation_block.hpp"

#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/balanced_truncation.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>

#include "records/record_arrays.hpp"

namespace bodeflow::validation {

void Truncation::describe(Describe& d) {
  d.id("validation.truncation").summary("The model with fewer states, by balanced truncation, and how far it is from data.");
  d.doc(
      "Keeps the states with the largest Hankel singular values. `error_bound`, twice the sum of those left out, bounds the "
      "largest error over all frequencies against the full model. With `response`: the root mean square and the largest |G - "
      "model| over the lines, as the models of the fits state them. The truncated model is not the best one of its order for "
      "the data; unstable models are refused.");
  d.reference("B. C. Moore, Principal component analysis in linear systems, 1981, doi:10.1109/TAC.1981.1102568");
  d.message_in(model).record_type("model");
  d.message_in(response).record_type("frequency_response").optional().doc("what the model is held against");
  d.message_out(out).record_type("model").doc("in form state_space, with `hankel_singular_values` of the full one");
  d.required<std::int64_t>("states").range(0, 10000).doc("states that are kept");
}

void Truncation::configure(const Parameters& p) { states_ = p.integer("states"); }

void Truncation::receive(int port, const RecordView& record, Io&) {
  if (port == response.index) {
    auto read = records::read_response(record);
    if (!read) fail("response: " + read.error().text);
    response_ = std::move(*read);
    return;
  }
  auto read = records::read_linear_model(record);
  if (!read) fail("model: " + read.error().text);
  model_ = std::move(*read);
}

void Truncation::finish(Io& io) {
  if (!model_) fail("no model arrived");
  const auto full = records::state_space_of(*model_);
  if (!full) fail(full.error().text);
  const auto reduced = numerics::balanced_truncation(*full, states_);
  if (!reduced) fail(reduced.error().text);
  records::ModelData m;
  m.method = "validation.truncation";
  m.form = "state_space";
  m.order = states_;
  m.sample_time_s = model_->sample_time_s;
  m.delay_s = model_->delay_s;
  m.state_space = reduced->system;
  m.poles = reduced->system.A.eigenvalues();
  m.inputs = model_->inputs;
  m.outputs = model_->outputs;
  m.input_name = model_->input_name;
  m.output_name = model_->output_name;
  m.input_unit = model_->input_unit;
  m.output_unit = model_->output_unit;
  m.band_hz = model_->band_hz;
  RecordBuilder r = records::write_model(m);
  r.set("error_bound", reduced->error_bound);
  records::put_list<double>(r, "hankel_singular_values", "", reduced->hankel_singular_values);
  if (response_) {
    if (response_->inputs() != full->inputs() || response_->outputs() != full->outputs())
      fail("response: its inputs and outputs are not those of the model");
    const auto at = numerics::frequency_response(reduced->system, response_->frequency_hz);
    double squares = 0.0, largest = 0.0, size = 0.0;
    for (Eigen::Index k = 0; k < response_->frequency_hz.size(); ++k)
      for (Eigen::Index e = 0; e < response_->response.cols(); ++e) {
        const std::complex<double> late = std::polar(1.0, -2.0 * M_PI * response_->frequency_hz[k] * m.delay_s);
        const double error =
            std::abs(response_->response(k, e) - late * at[static_cast<std::size_t>(k)](e / full->inputs(), e % full->inputs()));
        squares += error * error;
        largest = std::max(largest, error);
        size += std::norm(response_->response(k, e));
      }
    r.set("rms_error", std::sqrt(squares / static_cast<double>(response_->response.size())));
    r.set("max_error", largest);
    r.set("relative_error", size > 0.0 ? std::sqrt(squares / size) : NAN);
  }
  io.emit(out, r);
}

void Truncation::reset() {
  model_.reset();
  response_.reset();
}

}  // namespace bodeflow::validation
