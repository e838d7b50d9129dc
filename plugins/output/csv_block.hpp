#pragma once

#include <bodeflow/block.hpp>

#include "csv_table.hpp"
#include "text_file.hpp"

namespace bodeflow::output {

/// output.csv: writes streams to a CSV file in the run directory.
class CsvBlock final : public Block {
 public:
  static constexpr In<Any> in{0, "in"};
  static constexpr In<Any> in_2{1, "in_2"};
  static constexpr In<Any> in_3{2, "in_3"};
  static constexpr In<Any> in_4{3, "in_4"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  void write(std::string_view text);

  std::string name_;
  bool time_ = true;
  std::vector<std::string> columns_;
  std::vector<std::string> headers_;
  std::string path_;
  std::optional<TextFile> file_;
  Rate rate_;
  std::string rows_;  // text of one call
};

}  // namespace bodeflow::output
