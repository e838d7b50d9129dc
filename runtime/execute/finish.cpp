#include "execute/finish.hpp"

namespace bodeflow::execute {
namespace {

bool close_workers(Run& run) {
  for (const auto& worker : run.workers) {
    if (!worker->wait_all(run.finisher)) return false;
    worker->close();
  }
  return true;
}

}  // namespace

void finish_run(Run& run) {
  if (!close_workers(run)) return;
  const Time end = run.end_time();
  for (const int index : run.plan->order) {
    BlockRun& block = run.block(index);
    if (!block.has_streams() && !take_rest(block, end, run.finisher)) return;
    if (block.remote != nullptr && !block.remote->rested(block, run.finisher)) return;
  }
  for (const int index : run.plan->order) {
    BlockRun& block = run.block(index);
    if (!take_rest(block, end, run.finisher)) return;
    if (block.now < end) block.now = end;
    if (!finish(block, run.finisher)) return;
  }
}

}  // namespace bodeflow::execute
