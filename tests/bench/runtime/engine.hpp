#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bench {

struct EngineOptions {
  int threads = 1;
  long chunk = 1024;
  bool metrics = false;
};

/// Runs a graph text through loader, planner and executor with loaded plugins; blocks come from build/plugins and the benchmark's
/// own. The clock runs around execute alone: `prepare` is done before.
class Engine {
 public:
  Engine(const std::string& yaml, const EngineOptions& options);
  ~Engine();
  void run();
  /// The array `age` of the record that block `age` sent.
  std::vector<double> ages() const;

 private:
  struct State;
  State* state_;
};

/// source -> `blocks` times filters.gain -> sink, `samples` long.
std::string multiply_graph(int blocks, std::size_t samples);
/// A loop of filters.sum, filters.gain and filters.delay.
std::string feedback_graph(std::size_t samples);
/// stamp -> 8 copies -> age.
std::string latency_graph(std::size_t samples);
/// source -> two heavy blocks -> sink.
std::string heavy_graph(std::size_t samples);

}  // namespace bench
