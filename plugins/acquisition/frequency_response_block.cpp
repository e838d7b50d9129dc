#include "frequency_response_block.hpp"

#include <filesystem>

namespace bodeflow::acquisition {
namespace {

std::optional<std::pair<double, double>> band_of(const Parameters& p) {
  if (!p.has("band")) return std::nullopt;
  const std::vector<double>& band = p.numbers("band");
  if (band.size() != 2) fail("band has " + std::to_string(band.size()) + " frequencies; allowed: two, lowest and highest");
  if (!(band[0] >= 0.0) || !(band[1] > band[0])) fail("band must rise from a frequency of at least 0 Hz");
  return std::pair(band[0], band[1]);
}

}  // namespace

void FrequencyResponseBlock::describe(Describe& d) {
  d.id("acquisition.frequency_response").summary("Reads a frequency response from a file.").role("source");
  d.doc(
      "CSV (.csv .txt .tsv .dat: `f [Hz]` or `omega [rad/s]`, then re(G11), im(G11) ... or magnitude, absolute or in dB, and "
      "phase "
      "in deg or rad; var(G11) or std(G11) where known), Touchstone 1 (.s1p to .s99p), .frd and .zma (frequency, dB or ohm, "
      "deg), "
      "Universal Files (.uff .unv .u58: dataset 58, function type 4). The record is sent at the end of the run, so the block "
      "works "
      "in graphs without any stream. What was found is logged: points, band, grid, units, what was passed over and what looks "
      "wrong. A variance is that of the file or the one stated; else the record has none, and nothing is made up.");
  d.message_out(out).record_type("frequency_response");
  d.required<File>("file").doc("the file; its ending tells the format");
  d.parameter("quantity", std::vector<std::string>{})
      .doc("quantities to read where the file has more: names as in the file (S21, Z) or their letters (G: G11, G12 ...)");
  d.optional<std::vector<double>>("band").unit("Hz").doc("lowest and highest frequency; points outside are left out");
  d.parameter("unit", "").doc("unit of the response where the file does not say one: what a dB or a .frd file refers to");
  d.parameter("deviation.relative", 0.0)
      .unit("1")
      .range(0, 1)
      .doc("standard deviation of the complex value over its magnitude, for a file without variances");
  d.parameter("deviation.absolute", 0.0)
      .unit("")
      .range(0, 1e300)
      .doc("the same in the unit of the response; the two add in square");
  d.optional<double>("degrees_of_freedom")
      .range(0, 1e300)
      .doc("of the variances (P - 1 for P averaged periods): with them the record has confidence circles");
}

void FrequencyResponseBlock::configure(const Parameters& p) {
  path_ = p.text("file");
  auto table = read_response(path_, p.texts("quantity"));
  if (!table) fail(table.error().text);
  note_input(path_);
  auto response = assemble(std::move(*table), {p.texts("quantity"), band_of(p)});
  if (!response) fail(path_ + ": " + response.error().text);
  response_ = std::move(*response);
  certainty_.relative_deviation = p.number("deviation.relative");
  certainty_.absolute_deviation = p.number("deviation.absolute");
  if (p.has("degrees_of_freedom")) certainty_.degrees_of_freedom = p.number("degrees_of_freedom");
  if (auto done = state_variance(response_, certainty_); !done) fail(path_ + ": " + done.error().text);
  if (auto done = state_unit(response_, p.text("unit")); !done) fail(path_ + ": " + done.error().text);
  if (certainty_.degrees_of_freedom && response_.variance.empty())
    fail(path_ +
         ": degrees_of_freedom without variances; the file has none, deviation.relative or deviation.absolute states one");
  log_info(path_ + ": " + summary_of(response_));
  for (const std::string& warning : response_.warnings) log_warning(path_ + ": " + warning);
}

void FrequencyResponseBlock::finish(Io& io) {
  io.emit(out, response_record(response_, certainty_, std::filesystem::path(path_).filename().string()));
}

}  // namespace bodeflow::acquisition
