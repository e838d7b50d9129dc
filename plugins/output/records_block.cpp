#include "records_block.hpp"

#include "file_name.hpp"
#include "record_json.hpp"

namespace bodeflow::output {

void RecordsBlock::describe(Describe& d) {
  d.id("output.records").summary("Writes records of any type to a JSON lines file in the run directory.").role("sink");
  d.doc(
      "One line per record: time in seconds, type, attributes, arrays with unit, shape and flat row-major data; complex numbers "
      "as "
      "[re, im], values that are not finite as null.");
  d.message_in(in).doc("the records, of any type");
  d.parameter("file", "records.jsonl").doc("the file's name, inside the run directory");
}

void RecordsBlock::configure(const Parameters& p) { name_ = checked_file_name(p.text("file")); }

void RecordsBlock::activate(const Activation&) {
  const auto path = output_path(name_);
  if (!path) fail("no run directory to write '" + name_ + "' in");
  path_ = *path;
  reset();
}

void RecordsBlock::reset() {
  file_.reset();
  auto made = TextFile::create(path_);
  if (!made) fail(made.error().text);
  file_.emplace(std::move(*made));
}

void RecordsBlock::receive(int, const RecordView& record, Io& io) {
  // Records are rare and each may be the last before a crash: it goes to the system at once.
  auto done = file_->write(to_json_line(record, io.record_time()) + "\n");
  if (done) done = file_->flush();
  if (!done) fail(done.error().text);
}

void RecordsBlock::finish(Io&) {
  if (auto done = file_->close(); !done) fail(done.error().text);
}

void RecordsBlock::deactivate() {
  if (!file_) return;
  static_cast<void>(file_->close().has_value());
  file_.reset();
}

}  // namespace bodeflow::output
