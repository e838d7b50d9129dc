#include "transport/ledger.hpp"

#include <algorithm>
#include <utility>

namespace bodeflow::transport {
namespace {

constexpr std::chrono::milliseconds kNearPatience{500};  // readers on this host are found in shared memory well before

}  // namespace

void Ledger::reader_matched(Way way, const middleware::Guid& reader, bool yes) {
  const std::lock_guard lock(mutex_);
  if (yes) {
    readers_[way].insert(reader);
  } else {
    readers_[way].erase(reader);
    std::erase_if(inlets_, [&](const auto& entry) {
      if (way_ != way || entry.second.reader[way] != reader) return false;
      lost_ = true;
      untaken_of_gone_ = std::max(untaken_of_gone_, sent_ - entry.second.taken);
      return true;
    });
  }
  progress_.made();
  changed_.notify_all();
}

void Ledger::credit(Way way, const Credit& credit, bool same_host) {
  const std::lock_guard lock(mutex_);
  if (credit.stream != edge_.stream) return;
  const auto [entry, is_new] = inlets_.try_emplace(credit.inlet);
  auto& inlet = entry->second;
  if (is_new) inlet.taken = sent_;
  inlet.reader[way] = credit.reader;
  inlet.near = credit.near;
  inlet.same_host = inlet.same_host || same_host;
  if (credit.epoch == edge_.epoch && credit.taken > inlet.taken) {
    inlet.taken = std::min(credit.taken, sent_);
    progress_.made();
    forget_taken();
  }
  changed_.notify_all();
}

void Ledger::refused() {
  const std::lock_guard lock(mutex_);
  ++refused_;
}

bool Ledger::lives(const Inlet& inlet, Way way) const { return inlet.reader[way] && readers_[way].contains(*inlet.reader[way]); }

int Ledger::living(Way way) const {
  if (edge_.open || !edge_.lossless) return static_cast<int>(readers_[way].size());
  return static_cast<int>(std::count_if(inlets_.begin(), inlets_.end(), [&](const auto& e) { return lives(e.second, way); }));
}

/// The expected readers are there; way_ is what they share.
bool Ledger::choose() {
  if (way_ && living(*way_) >= edge_.readers) {
    if (std::exchange(lost_, false)) ++reconnects_;
    return true;
  }
  if (way_ && living(*way_) > 0) return false;
  std::optional<Way> found;
  if (edge_.readers == 0 || living(kFar) >= edge_.readers) found = kFar;
  if (edge_.readers > 0 && living(kNear) >= edge_.readers) found = kNear;
  if (!found) return false;
  const auto now = std::chrono::steady_clock::now();
  const bool hopes = *found == kFar && !edge_.open && std::any_of(inlets_.begin(), inlets_.end(), [&](const auto& entry) {
    return lives(entry.second, kFar) && entry.second.near && entry.second.same_host;
  });
  if (hopes && has_near_) {
    if (!near_awaited_) near_awaited_ = now + kNearPatience;
    if (now < *near_awaited_) return false;
  }
  if (std::exchange(lost_, false)) ++reconnects_;
  was_ready_ = true;
  way_ = found;
  near_awaited_.reset();
  return true;
}

std::uint64_t Ledger::spent_at(std::uint64_t sequence) const {
  if (sequence <= first_) return spends_.empty() ? spent_ : spends_.front();
  return spends_[std::min<std::uint64_t>(sequence - first_, spends_.size() - 1)];
}

std::uint64_t Ledger::least_taken() const {
  auto least = sent_;
  for (const auto& [id, inlet] : inlets_) {
    if (way_ && lives(inlet, *way_)) least = std::min(least, inlet.taken);
  }
  return least;
}

/// spends_[k] is the cost of all before message first_ + k.
void Ledger::forget_taken() {
  const auto least = least_taken();
  while (first_ < least && spends_.size() > 1) {
    spends_.pop_front();
    ++first_;
  }
}

bool Ledger::fits(std::uint64_t cost) {
  const auto under_way = spent_ - (spends_.empty() ? spent_ : spent_at(least_taken()));
  return under_way == 0 || under_way + cost <= edge_.queue_bytes;
}

tl::expected<Way, Failure> Ledger::wait_for_readers(const GoOn& go_on) {
  std::unique_lock lock(mutex_);
  if (const auto kind = wait_for(lock, changed_, progress_, go_on, [&] { return choose(); }))
    return tl::unexpected(give_up(*kind));
  return *way_;
}

tl::expected<Ledger::Ticket, Failure> Ledger::book(std::uint64_t payload, const GoOn& go_on) {
  const auto cost = payload + kOverhead;
  std::unique_lock lock(mutex_);
  const auto free = [&] { return choose() && fits(cost); };
  if (const auto kind = wait_for(lock, changed_, progress_, go_on, free)) return tl::unexpected(give_up(*kind));
  if (spends_.empty()) {
    spends_.push_back(spent_);
    first_ = sent_;
  }
  spent_ += cost;
  spends_.push_back(spent_);
  const Ticket ticket{*way_, sent_++};
  forget_taken();
  return ticket;
}

std::uint64_t Ledger::book_latest() {
  const std::lock_guard lock(mutex_);
  return sent_++;
}

bool Ledger::has_readers(Way way) const {
  const std::lock_guard lock(mutex_);
  return !readers_[way].empty();
}

bool Ledger::still_there() const {
  const std::lock_guard lock(mutex_);
  return way_ && living(*way_) >= edge_.readers;
}

std::uint64_t Ledger::sent() const {
  const std::lock_guard lock(mutex_);
  return sent_;
}

Failure Ledger::failure(Failure::Kind kind) const {
  const std::lock_guard lock(mutex_);
  return give_up(kind);
}

Failure Ledger::give_up(Failure::Kind kind) const {
  const auto where = "topic '" + edge_.topic + "': ";
  if (kind != Failure::Kind::tolerance) return {kind, where + "stopped"};
  const auto time = seconds_text(edge_.tolerance_s);
  const int here = way_ ? living(*way_) : living(kFar);
  if (here < edge_.readers) {
    const auto count = std::to_string(here) + " of " + std::to_string(edge_.readers) + " readers";
    if (!was_ready_) return {kind, where + "only " + count + " came within " + time};
    return {Failure::Kind::peer, where + "only " + count + " are left, for " + time + "; of " + std::to_string(sent_) +
                                     " messages " + std::to_string(untaken_of_gone_) + " were not confirmed as taken"};
  }
  return {kind, where + "no reader took anything for " + time + "; of " + std::to_string(sent_) + " messages " +
                    std::to_string(sent_ - least_taken()) + " are not taken"};
}

void Ledger::tell(EdgeState& state) const {
  const std::lock_guard lock(mutex_);
  state.matched = way_ && living(*way_) >= edge_.readers;
  if (!edge_.lossless) state.matched = !readers_[kFar].empty() || !readers_[kNear].empty();
  state.refused = refused_;
  state.reconnects = reconnects_;
  const auto least = least_taken();
  const auto under_way = spends_.empty() ? 0 : spent_ - spent_at(least);
  state.queued_bytes = under_way - std::min(under_way, kOverhead * (sent_ - least));
  state.waited_s = progress_.waited_s();
  state.stalled_s = progress_.stalled_s();
}

}  // namespace bodeflow::transport
