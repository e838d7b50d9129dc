#pragma once

#include <functional>

namespace bodeflow::transport {

/// Runs `work` on a thread of its own and waits up to two seconds for it. Fast DDS can lock itself up when readers leave: then
/// the thread and what `work` owns are left behind, and the process ends without destructors of static objects.
void leave(std::function<void()> work);

}  // namespace bodeflow::transport
