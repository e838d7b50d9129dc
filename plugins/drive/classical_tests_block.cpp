#include "classical_tests_block.hpp"

#include <algorithm>
#include <cmath>

#include "records/model.hpp"
#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

constexpr std::array kPorts{ClassicalTests::dc, ClassicalTests::no_load, ClassicalTests::locked_rotor};

double number_in(const RecordView& record, const char* port, const char* name) {
  const auto value = record.number(name);
  if (!value || !std::isfinite(*value)) fail(std::string(port) + ": no number '" + name + "' in the record");
  return *value;
}

records::ModelData model_of(const MotorParameters& motor) {
  const ModelConstants c = constants_of(motor);
  records::ModelData m;
  m.method = "drive.classical_tests";
  m.form = "physical";
  m.order = 2;
  m.parameter_names = {"Rs", "Rr", "Ls", "Lr", "Lm", "sigma", "beta", "alpha", "gamma"};
  m.parameter_units = {"ohm", "ohm", "H", "H", "H", "H", "1/H", "1/s", "1/s"};
  m.parameters = Eigen::VectorXd{{motor.rs, motor.rr, motor.ls, motor.lr, motor.lm, c.sigma, c.beta, c.alpha, c.gamma}};
  m.numerator = Eigen::Vector2d(1, c.alpha) / c.sigma;
  m.denominator = Eigen::Vector3d(1, c.gamma + c.alpha, c.alpha * (c.gamma - c.alpha * c.lm_beta));
  // Real: the circuit is passive and has one kind of store.
  const double half = m.denominator[1] / 2, root = std::sqrt(half * half - m.denominator[2]);
  m.poles = Eigen::Vector2cd(-m.denominator[2] / (half + root), -(half + root));
  m.zeros = Eigen::VectorXcd::Constant(1, -c.alpha);
  m.input_name = "voltage";
  m.output_name = "current";
  m.input_unit = "V";
  m.output_unit = "A";
  m.conventions = {"rms values per phase of the star in the tests", "rotor referred to the stator, Lr = Ls assumed",
                   "transfer function: standstill, voltage to current of one axis, amplitude-invariant Clarke",
                   "Rr and the leakage are those at the frequency of the locked-rotor test"};
  return m;
}

}  // namespace

void ClassicalTests::describe(Describe& d) {
  d.id("drive.classical_tests")
      .summary("Gives the parameters of an induction motor from its classical tests: dc, no load, locked rotor.");
  d.doc(
      "Equivalent circuit of a phase: Rs is the resistance at dc, w Ls the reactance without load (the rotor at synchronous "
      "speed), and Rr, Lm follow from the impedance with the rotor locked, with Lr = Ls. The closed form of what the iteration "
      "of "
      "IEEE Std 112 goes to. Rr is that at the frequency of the locked-rotor test: bars with skin effect have less at the "
      "frequencies of a standstill experiment. Mechanical slip without load makes Ls too small; losses without load are told.");
  d.reference("W. Leonhard, Control of Electrical Drives, 1995, chapter 10");
  d.reference("IEEE Std 112-2017, IEEE Standard Test Procedure for Polyphase Induction Motors and Generators");
  const char* docs[] = {"of a drive.power_meter: direct current through the alpha axis",
                        "fed at about the rated frequency, without load", "with the rotor locked"};
  for (std::size_t k = 0; k < kPorts.size(); ++k) d.message_in(kPorts[k]).record_type("power_measurement").doc(docs[k]);
  d.message_out(model).record_type("model").doc("Rs, Rr, Ls, Lr, Lm and the constants sigma, beta, alpha, gamma of them");
  d.parameter("published", std::vector<double>{})
      .unit("1")
      .doc("the same nine figures of a publication, to stand beside, or none");
}

void ClassicalTests::configure(const Parameters& p) {
  published_ = p.numbers("published");
  if (published_.empty() || published_.size() == 9) return;
  fail("published has " + std::to_string(published_.size()) +
       " values, allowed: none, or nine: Rs, Rr, Ls, Lr, Lm, sigma, beta, "
       "alpha, gamma");
}

void ClassicalTests::receive(int port, const RecordView& record, Io&) {
  const auto k = static_cast<std::size_t>(port);
  const char* name = kPorts[k].name;
  if (tests_[k]) fail(std::string(name) + ": a second record arrived, allowed: one");
  tests_[k] = PhaseImpedance{number_in(record, name, "frequency"),
                             {number_in(record, name, "resistance"), number_in(record, name, "reactance")}};
  if ((tests_[k]->frequency_hz == 0) != (k == 0)) {
    fail(std::string(name) + ": a test at " + records::short_number(tests_[k]->frequency_hz) +
         " Hz, allowed: " + (k == 0 ? "0 Hz" : "above 0 Hz"));
  }
  if (k == 1) no_load_current_ = number_in(record, name, "current");
}

void ClassicalTests::finish(Io& io) {
  for (std::size_t k = 0; k < kPorts.size(); ++k) {
    if (!tests_[k]) fail(std::string("no record arrived at '") + kPorts[k].name + "', allowed: one");
  }
  const auto motor = motor_of_tests(tests_[0]->value.real(), *tests_[1], *tests_[2]);
  if (!motor) fail(motor.error().text);
  RecordBuilder r = records::write_model(model_of(*motor));
  r.set("no_load_losses", 3 * no_load_current_ * no_load_current_ * (tests_[1]->value.real() - motor->rs));
  r.set("locked_rotor_frequency", tests_[2]->frequency_hz);
  if (!published_.empty()) {
    const auto figures = r.array<double>("published_parameters", "", {published_.size()});
    std::copy(published_.begin(), published_.end(), figures.begin());
  }
  io.emit(model, r);
}

}  // namespace bodeflow::drive
