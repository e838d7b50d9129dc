#pragma once

#include <deque>
#include <vector>

#include "execute/execute.hpp"
#include "observe/newest.hpp"

namespace bodeflow::observe {

/// The last record that a message output sent.
struct Sent {
  SharedRecord record;
  double time_s = 0.0;
  std::uint64_t count = 0;  ///< records that it has sent, this one included
};

/// The value that a live parameter took last.
struct Taken {
  ParameterValue value;
};

/// Stands before the sink of a phase, gives on all that comes, and keeps the newest record of each message output and the newest
/// value of each parameter for one thread that looks now and then. The threads of the run never wait for that one.
class Tap final : public execute::Sink {
 public:
  Tap(const graph::Phase& phase, execute::Sink& sink);

  tl::expected<void, std::string> samples(int recorded, const void* const* channels, std::uint64_t count) override;
  tl::expected<void, std::string> record(graph::End from, const SharedRecord& record, double time_s) override;
  void changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, execute::Cause cause) override;

  /// What came since the last look, or nothing. One thread at a time.
  std::unique_ptr<Sent> take_record(graph::End from);
  std::unique_ptr<Taken> take_value(int block, int parameter);

 private:
  struct Output {
    std::uint64_t count = 0;  ///< of the thread that runs the block
    Newest<Sent> last;
  };
  struct Block {
    std::deque<Output> outputs;
    std::deque<Newest<Taken>> parameters;
  };

  execute::Sink& sink_;
  std::vector<Block> blocks_;
};

}  // namespace bodeflow::observe
