#include "merge_block.hpp"

#include "merge.hpp"

namespace bodeflow::spectrum {

void MergeBlock::describe(Describe& d) {
  d.id("spectrum.merge").summary("Merges the frequency responses of several experiments or bands into one.");
  d.doc(
      "Every record that arrives is an experiment of its own, so producers send one each (`every` left at 0). Lines at the same "
      "frequency are "
      "averaged with inverse variances; other lines are joined in order of frequency. A warning names the experiments and lines "
      "that "
      "disagree beyond chance. Inputs, outputs and units must have the same names.");
  d.reference("W. G. Cochran, The combination of estimates from different experiments, 1954, doi:10.2307/3001666");
  d.reference("P. Meier, Variance of a weighted mean, 1953, doi:10.2307/3001633");
  d.message_in(in).record_type("frequency_response").doc("the frequency responses, from as many blocks as wished");
  d.message_out(out).record_type("frequency_response").doc("the merged one, at the end");
}

void MergeBlock::receive(int, const RecordView& record, Io&) {
  auto data = read_response(record);
  if (!data) fail("experiment " + std::to_string(experiments_.size() + 1) + ": " + data.error().text);
  experiments_.push_back(std::move(*data));
}

void MergeBlock::finish(Io& io) {
  const auto merged = merge(experiments_);
  if (!merged) fail(merged.error().text);
  RecordBuilder record = write_response(*merged);
  record.set("experiments", experiments_.size());
  io.emit(out, record);
  // Those of the experiments come first; whoever made them has told them.
  std::size_t told = 0;
  for (const ResponseData& experiment : experiments_) told += experiment.warnings.size();
  for (std::size_t w = told; w < merged->warnings.size(); ++w) log_warning(merged->warnings[w]);
}

void MergeBlock::reset() { experiments_.clear(); }

}  // namespace bodeflow::spectrum
