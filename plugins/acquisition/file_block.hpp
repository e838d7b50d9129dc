#pragma once

#include <bodeflow/block.hpp>
#include <memory>

#include "scan.hpp"

namespace bodeflow::acquisition {

/// acquisition.file: a source whose samples stand in a data file.
class FileBlock final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};
  static constexpr Out<double> input{1, "input"};
  static constexpr Out<double> output{2, "output"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  /// The columns of one port, as places in `selected_`.
  using Channels = std::vector<std::size_t>;

  Channels select(const std::vector<std::string>& names, const char* parameter);
  void select_all(const Timing& timing);
  std::size_t place_of(std::size_t column);
  Part read_part(const Parameters& p) const;
  void scan(const Timing& timing);
  void state(Out<double> port, const Channels& channels, Facts& f) const;
  void give(Out<double> port, const Channels& channels, std::size_t rows, Io& io) const;

  std::string path_;
  std::unique_ptr<TableReader> reader_;
  Part part_;
  TableSummary summary_;
  std::vector<std::size_t> selected_;  // columns of the file that are read
  Channels out_channels_, input_channels_, output_channels_;
  std::vector<std::vector<double>> rows_;  // of one call, by place in selected_
  std::vector<double*> places_;            // of rows_
  std::int64_t done_ = 0;
};

}  // namespace bodeflow::acquisition
