#pragma once

#include <bodeflow/block.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "blocks/reveal.hpp"

namespace bodeflow::residual {

/// residual.reveal: holds a trace against the truth.
class Reveal final : public Block {
 public:
  static constexpr MessageIn trace{0, "trace"};
  static constexpr MessageIn truth{1, "truth"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  struct Said {
    Answer answer;
    std::vector<std::string> parameter_names, parameter_units;
    std::vector<double> before, after, after_std;
  };
  struct Truth {
    std::vector<HiddenTruth> hidden;
    std::optional<Eigen::Vector4d> motor;
    std::map<std::string, double> by_name;  ///< of the base model's parameters
  };
  std::vector<double> true_values() const;

  std::optional<Said> said_;
  std::optional<Truth> truth_;
};

}  // namespace bodeflow::residual
