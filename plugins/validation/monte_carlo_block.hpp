#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <vector>

#include "run_responses.hpp"
#include "sweep_quantities.hpp"

namespace bodeflow::validation {

/// validation.monte_carlo: mean and spread of what the runs of a sweep gave, beside the truth and published figures.
class MonteCarlo final : public Block {
 public:
  static constexpr MessageIn sweep{0, "sweep"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut response{1, "response"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void relabel();
  RecordBuilder study() const;

  std::vector<std::string> sources_, names_, units_;
  std::vector<double> scale_, truth_, published_mean_, published_std_;
  FrequencyGrid grid_;

  std::vector<Quantity> quantities_;
  std::int64_t runs_ = 0;
  std::vector<double> seeds_;  ///< of the runs, where the sweep went over seeds
  std::string of_;             ///< what the runs' records were
  std::optional<records::ResponseData> mean_response_;
};

}  // namespace bodeflow::validation
