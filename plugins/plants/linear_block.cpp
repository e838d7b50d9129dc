#include "linear_block.hpp"

#include <algorithm>

#include "model_parameters.hpp"

namespace bodeflow::plants {
namespace {

void require_count(const char* name, std::size_t found, Eigen::Index outputs) {
  if (found == 0 || found == static_cast<std::size_t>(outputs)) return;
  fail(std::string(name) + " has " + std::to_string(found) + " entries, allowed: one for each of the " + std::to_string(outputs) +
       " outputs");
}

}  // namespace

void Linear::describe(Describe& d) {
  d.id("plants.linear")
      .summary("Simulates a linear plant, exactly at the sample times.")
      .role("plant")
      .realtime_safe()
      .in_place()
      .cost_ns(5);
  d.doc(
      "A continuous-time model is driven by its input held over each sample (zero-order hold) and, after that, delayed by "
      "`delay`, which need not be "
      "whole: x[n+1] = Phi x[n] + Gamma_1 u[n-d-1] + Gamma_0 u[n-d], with the matrix exponential, so the output at sample n is "
      "right to rounding, "
      "however stiff the model is. Channels of the input are the model's inputs. Without feed-through (D = 0, or a delay that "
      "holds the input "
      "up) the output waits for the input of the sample before, so the plant can stand in a feedback loop. The input before the "
      "first sample is 0.");
  d.reference("K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 3rd ed., 1997, section 3.2");
  d.reference("C. F. Van Loan, Computing integrals involving the matrix exponential, 1978, doi:10.1109/TAC.1978.1101743");
  describe_model(d);
  d.parameter("delay", 0.0)
      .unit("s")
      .range(0, 1e6)
      .doc("from input to output, in addition to the model's own; not needed to be whole samples");
  d.optional<std::vector<double>>("initial_state")
      .unit("")
      .doc("x at the first sample, for a model given by a, b, c and d; zeros otherwise");
  d.parameter("unit", "").doc("unit of the output");
  d.parameter("output_names", std::vector<std::string>{}).doc("one name an output channel");
  d.parameter("output_units", std::vector<std::string>{}).doc("one unit an output channel, where they differ");
  d.stream_in(in).doc("one channel for each input of the model");
  d.stream_out(out).doc("one channel for each output of the model");
}

void Linear::configure(const Parameters& p) {
  model_ = read_model(p);
  dynamics_ = dynamics_of(model_);
  delay_s_ = p.number("delay");
  unit_ = p.text("unit");
  output_names_ = p.texts("output_names");
  output_units_ = p.texts("output_units");
  require_count("output_names", output_names_.size(), model_.outputs());
  require_count("output_units", output_units_.size(), model_.outputs());
  initial_state_.assign(static_cast<std::size_t>(model_.states()), 0.0);
  if (!p.has("initial_state")) return;
  if (!given_by_matrices(p)) fail("initial_state goes with a model given by a, b, c and d");
  if (p.numbers("initial_state").size() != initial_state_.size()) {
    fail("initial_state has " + std::to_string(p.numbers("initial_state").size()) +
         " values, allowed: " + std::to_string(initial_state_.size()) + ", one a state");
  }
  initial_state_ = p.numbers("initial_state");
}

void Linear::resolve(Facts& f) {
  const StreamFacts& u = f.in(in);
  if (!u.known) {
    f.delay(in, model_.has_feedthrough() ? 0 : 1);
    return;
  }
  if (u.channels != model_.inputs()) {
    fail("the model has " + std::to_string(model_.inputs()) + (model_.inputs() == 1 ? " input" : " inputs") +
         ", the stream at 'in' has " + std::to_string(u.channels) + (u.channels == 1 ? " channel" : " channels"));
  }
  f.delay(in, value_or_fail(input_delay(model_, 1.0 / u.rate.hz(), delay_s_)));
  StreamFacts& y = f.out(out);
  y.known = true;
  y.channels = static_cast<int>(model_.outputs());
  y.rate = u.rate;
  y.length = u.length;
  y.clock = u.clock;
  y.unit = unit_;
  y.channel_names = output_names_;
  y.channel_units = output_units_;
  state_notes(u, y);
}

/// A linear plant keeps the lines of its excitation, not their amplitudes.
void Linear::state_notes(const StreamFacts& u, StreamFacts& y) const {
  for (const char* name : {"excitation.period", "excitation.experiment", "excitation.frequencies"}) {
    if (u.notes.count(name) != 0) y.notes[name] = u.note(name);
  }
  std::vector<double>& modes = y.notes["plant.modes"] = u.note("plant.modes");
  modes.insert(modes.end(), dynamics_.modes_hz.begin(), dynamics_.modes_hz.end());
  std::sort(modes.begin(), modes.end());
  const std::vector<double> before = u.note("plant.settling_time");
  y.notes["plant.settling_time"] = {std::max(dynamics_.settling_s, before.empty() ? 0.0 : before[0])};
}

void Linear::activate(const Activation& a) {
  SampledPlant plant = value_or_fail(sampled_plant(model_, 1.0 / a.rate.hz(), delay_s_));
  std::vector<double> initial = initial_state_;
  initial.resize(static_cast<std::size_t>(plant.model.states()), 0.0);  // the held input of a delay that is not whole
  simulator_ = Simulator(plant.model, initial, plant.late);
  inputs_.resize(static_cast<std::size_t>(model_.inputs()));
  outputs_.resize(static_cast<std::size_t>(model_.outputs()));
}

void Linear::process(Io& io) {
  for (std::size_t j = 0; j < inputs_.size(); ++j) inputs_[j] = io.read(in, static_cast<int>(j)).data();
  for (std::size_t i = 0; i < outputs_.size(); ++i) outputs_[i] = io.write(out, static_cast<int>(i)).data();
  simulator_.run(inputs_.data(), outputs_.data(), io.count());
}

void Linear::reset() { simulator_.reset(); }

}  // namespace bodeflow::plants
