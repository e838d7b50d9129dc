#include "known_motor_block.hpp"

#include "physical_parameters.hpp"
#include "records/record_arrays.hpp"

namespace bodeflow::frisch {

void KnownMotor::describe(Describe& d) {
  d.id("frisch.known_motor").summary("Gives the model of a motor at standstill whose resistances and inductances are known.");
  d.doc(
      "gamma = Rs/sigma + alpha Lm_beta, alpha = Rr/Lr, Lm_beta = Lm^2/(sigma Lr), sigma = Ls - Lm^2/Lr, as frisch.motor "
      "estimates them. Beside an estimate: its deviation from the known values, and that over its standard deviation. For "
      "simulated motors, and for data from a nameplate or from no-load and locked-rotor tests.");
  d.message_in(estimate).optional().record_type("model").doc("the model to place beside it; the last one counts");
  d.message_out(model).record_type("model");
  d.message_out(deviation).record_type("deviation").doc("where an estimate arrived: it beside the known values");
  d.required<double>("rs").unit("ohm").above(0.0).doc("stator resistance");
  d.required<double>("rr").unit("ohm").above(0.0).doc("rotor resistance");
  d.required<double>("ls").unit("H").above(0.0).doc("stator inductance");
  d.required<double>("lr").unit("H").above(0.0).doc("rotor inductance");
  d.required<double>("lm").unit("H").above(0.0).doc("mutual inductance, lm^2 below ls lr");
}

void KnownMotor::configure(const Parameters& p) {
  const auto motor = motor_model(p.number("rs"), p.number("rr"), p.number("ls"), p.number("lr"), p.number("lm"));
  if (!motor) fail(motor.error().text);
  motor_ = *motor;
}

void KnownMotor::activate(const Activation&) { reset(); }

void KnownMotor::receive(int, const RecordView& record, Io&) {
  auto read = records::read_model(record);
  if (!read) fail("estimate: " + read.error().text);
  if (read->parameter_names != motor_parameter_names()) {
    fail("estimate: a model by " + read->method +
         " without the parameters gamma, alpha, Lm_beta, sigma; needed: one by frisch.motor");
  }
  estimate_ = std::move(*read);
}

RecordBuilder KnownMotor::compared() const {
  const Eigen::VectorXd known = motor_.vector(), found = estimate_->parameters;
  RecordBuilder r("deviation");
  r.set("parameter_names", estimate_->parameter_names);
  r.set("parameter_units", estimate_->parameter_units);
  records::put_list<double>(r, "known", "", known);
  records::put_list<double>(r, "estimate", "", found);
  records::put_list<double>(r, "relative_deviation", "", (found.cwiseQuotient(known) - Eigen::VectorXd::Ones(4)).eval());
  if (estimate_->covariance.size() == 0) return r;
  const Eigen::VectorXd std = estimate_->covariance.diagonal().cwiseSqrt();
  records::put_list<double>(r, "std", "", std);
  records::put_list<double>(r, "deviation_over_std", "", (found - known).cwiseQuotient(std).eval());
  return r;
}

void KnownMotor::finish(Io& io) {
  records::ModelData d;
  d.method = "frisch.known_motor";
  d.form = "physical";
  d.order = 2;
  d.parameter_names = motor_parameter_names();
  d.parameter_units = {"1/s", "1/s", "1", "H"};
  d.parameters = motor_.vector();
  d.numerator = transfer_numerator(motor_);
  d.denominator = transfer_denominator(motor_);
  d.poles = poles(motor_).cast<std::complex<double>>();
  d.zeros = Eigen::VectorXcd::Constant(1, -motor_.alpha);
  d.input_name = "voltage";
  d.output_name = "current";
  d.input_unit = "V";
  d.output_unit = "A";
  d.conventions = {
      "one axis of the stator frame, amplitude-invariant Clarke: peak values of a phase, per-phase star equivalent circuit",
      "known, not estimated"};
  io.emit(model, records::write_model(d));
  if (estimate_) io.emit(deviation, compared());
}

void KnownMotor::reset() { estimate_.reset(); }

}  // namespace bodeflow::frisch
