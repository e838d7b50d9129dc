#pragma once

#include <bodeflow/block.hpp>

#include "text_file.hpp"

namespace bodeflow::output {

/// output.records: writes each record as a line of JSON to a file in the run directory.
class RecordsBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void receive(int message_port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  std::string name_;
  std::string path_;
  std::optional<TextFile> file_;
};

}  // namespace bodeflow::output
