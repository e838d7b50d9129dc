#include "execute/inbox.hpp"

#include <algorithm>
#include <utility>

namespace bodeflow::execute {

bool before(const Entry& a, const Entry& b) {
  if (a.time < b.time) return true;
  if (b.time < a.time) return false;
  if (a.edge != b.edge) return a.edge < b.edge;
  const bool a_first = a.kind == Entry::Kind::barrier, b_first = b.kind == Entry::Kind::barrier;
  if (a_first != b_first) return a_first;
  return a.sequence < b.sequence;
}

void Inbox::add(Entry entry) {
  if (entry.kind == Entry::Kind::change) ++changes_;
  const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(head_);
  entries_.insert(std::upper_bound(first, entries_.end(), entry, before), std::move(entry));
}

void Inbox::send(Entry entry) {
  const std::lock_guard lock(mutex_);
  incoming_.push_back(std::move(entry));
  sent_.store(true, std::memory_order_release);
}

void Inbox::announce(int edge, const Horizon& horizon) {
  const std::lock_guard lock(mutex_);
  announced_[edge] = horizon;
}

Horizon Inbox::announced(int edge) {
  const std::lock_guard lock(mutex_);
  return announced_[edge];
}

void Inbox::bring_in() {
  const std::lock_guard lock(mutex_);
  sent_.store(false, std::memory_order_relaxed);
  for (Entry& entry : incoming_) add(std::move(entry));
  incoming_.clear();
}

Entry Inbox::pop() {
  Entry entry = std::move(entries_[head_++]);
  if (entry.kind == Entry::Kind::change) --changes_;
  constexpr std::size_t kKeep = 64;  // taken entries that may stand before the vector is moved up
  if (head_ == entries_.size()) {
    entries_.clear();
    head_ = 0;
  } else if (head_ >= kKeep && 2 * head_ >= entries_.size()) {
    entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(head_));
    head_ = 0;
  }
  return entry;
}

}  // namespace bodeflow::execute
