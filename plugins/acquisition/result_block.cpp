#include "result_block.hpp"

#include "result_file.hpp"

namespace bodeflow::acquisition {

void ResultBlock::describe(Describe& d) {
  d.id("acquisition.result")
      .summary("Gives a record that an earlier run left: a model, a frequency response, any type.")
      .role("source");
  d.doc(
      "Reads `result.json`, by itself or in a run directory. The record is sent at the end of the run, as it was; a number that "
      "the "
      "file holds as null is NaN.");
  d.message_out(out).doc("the record");
  d.required<File>("file").doc("a run directory, or its result.json");
  d.parameter("name", "")
      .doc("the result's name, such as identify; default: the only one there is (of `type`), or of several identify");
  d.parameter("type", "").doc("the type that it must have, such as model; default: any");
}

void ResultBlock::configure(const Parameters& p) {
  auto result = read_result(p.text("file"), p.text("name"), p.text("type"));
  if (!result) fail(result.error().text);
  note_input(result->file);
  log_info(result->file + ": result '" + result->name + "' (" + result->record.type() + ")");
  if (!result->run_status.empty() && result->run_status != "complete")
    log_warning(result->file + ": the run is " + result->run_status + ": its results may not be its last");
  record_ = std::move(result->record);
}

void ResultBlock::finish(Io& io) { io.emit(out, *record_); }

}  // namespace bodeflow::acquisition
