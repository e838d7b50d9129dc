#include "blocks/amplitude_block.hpp"

#include "records/recording.hpp"

namespace bodeflow::residual {

void AmplitudeBlock::describe(Describe& d) {
  d.id("residual.amplitude")
      .summary("Chooses the amplitude of the next experiment from a pilot: noise, current and declared limits.");
  d.doc(
      "The amplitude at which the output has the wanted signal-to-noise ratio, everything scaled from the pilot, or as much as "
      "the limits "
      "allow. It is sent as a `parameter_change`, so that a later phase connects it to a block: $pilot.amplitude -> "
      "amplifier.parameters. Where the plant is not linear the output may grow faster than the amplitude: `margin` is for that.");
  d.message_in(in).record_type("recording").doc("the pilot, periodic, one input and one output");
  d.message_out(out).record_type("parameter_change").doc("parameter and value, and what they follow from");
  d.parameter("parameter", "gain").doc("name of the live parameter that is to change");
  d.parameter("pilot", 1.0).unit("").above(0).doc("its value in the pilot");
  d.parameter("signal_to_noise", 30.0)
      .unit("dB")
      .range(0, 120)
      .doc("wanted, of the output: root mean squares of signal and noise");
  d.required<double>("largest_input").unit("").above(0).doc("peak value that is allowed, in the unit of the input");
  d.required<double>("largest_output").unit("").above(0).doc("peak value that is allowed, in the unit of the output");
  d.parameter("margin", 0.8).unit("1").range(0.05, 1).doc("part of these limits that is used");
}

void AmplitudeBlock::configure(const Parameters& p) {
  parameter_ = p.text("parameter");
  pilot_ = p.number("pilot");
  wish_ = {p.number("signal_to_noise"), p.number("largest_input"), p.number("largest_output"), p.number("margin")};
}

void AmplitudeBlock::receive(int, const RecordView& record, Io& io) {
  const auto recording = records::read_recording(record);
  if (!recording) fail(recording.error().text);
  const auto choice = choose_amplitude(*recording, pilot_, wish_);
  if (!choice) fail(choice.error().text);
  const AmplitudeChoice& c = *choice;
  RecordBuilder r("parameter_change");
  r.set("parameter", parameter_).set("value", c.amplitude).set("factor", c.factor).set("limited_by", c.limited_by);
  r.set("noise_std", c.noise_std).set("output_rms", c.output_rms).set("output_peak", c.output_peak);
  r.set("input_peak", c.input_peak).set("signal_to_noise_db", c.signal_to_noise_db);
  io.emit(out, r);
}

}  // namespace bodeflow::residual
