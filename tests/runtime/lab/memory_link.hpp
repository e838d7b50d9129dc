#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "transport/link.hpp"

namespace bodeflow::test {

/// A link inside a process that holds `most` bytes.
struct MemoryLink {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<transport::Message> queue;
  std::uint64_t bytes = 0, most = 1 << 16;
  std::uint64_t messages = 0, lost_after = ~std::uint64_t{0};  ///< what the writer sends behind so many comes to nobody

  /// Waits until as many messages have been sent; false: `seconds` have passed.
  bool wait_until_lost(double seconds) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return messages >= lost_after; });
  }
  void lose() {
    const std::lock_guard lock(mutex);
    lost_after = 0;
  }

  template <class Ready>
  tl::expected<void, transport::Failure> wait(std::unique_lock<std::mutex>& lock, const transport::GoOn& go_on, Ready ready) {
    while (!changed.wait_for(lock, std::chrono::milliseconds(20), ready))
      if (!go_on()) return tl::unexpected(transport::Failure{transport::Failure::Kind::stopped, "stopped"});
    return {};
  }
};

class MemoryOutlet final : public transport::Outlet {
 public:
  explicit MemoryOutlet(std::shared_ptr<MemoryLink> link) : link_(std::move(link)) {}
  tl::expected<void, transport::Failure> connect(const transport::GoOn&) override { return {}; }
  tl::expected<void, transport::Failure> send(transport::Header header, std::span<const std::span<const std::byte>> parts,
                                              const transport::GoOn& go_on) override {
    transport::Message message{std::move(header), {}};
    for (const auto& part : parts) message.payload.insert(message.payload.end(), part.begin(), part.end());
    std::unique_lock lock(link_->mutex);
    if (link_->messages >= link_->lost_after) return {};
    const auto room = [&] { return link_->queue.empty() || link_->bytes + message.payload.size() <= link_->most; };
    if (auto waited = link_->wait(lock, go_on, room); !waited) return waited;
    link_->bytes += message.payload.size();
    link_->queue.push_back(std::move(message));
    ++link_->messages;
    link_->changed.notify_all();
    return {};
  }
  tl::expected<void, transport::Failure> drain(const transport::GoOn&) override { return {}; }
  transport::EdgeState state() const override { return {}; }

 private:
  std::shared_ptr<MemoryLink> link_;
};

class MemoryInlet final : public transport::Inlet {
 public:
  explicit MemoryInlet(std::shared_ptr<MemoryLink> link) : link_(std::move(link)) {}
  tl::expected<transport::Message, transport::Failure> next(const transport::GoOn& go_on) override {
    std::unique_lock lock(link_->mutex);
    if (auto waited = link_->wait(lock, go_on, [&] { return !link_->queue.empty(); }); !waited)
      return tl::unexpected(waited.error());
    transport::Message message = std::move(link_->queue.front());
    link_->queue.pop_front();
    link_->bytes -= message.payload.size();
    link_->changed.notify_all();
    return message;
  }
  tl::expected<std::optional<transport::Message>, transport::Failure> poll(double) override {
    {
      const std::lock_guard lock(link_->mutex);
      if (link_->queue.empty()) return std::optional<transport::Message>();
    }
    return next([] { return true; }).map([](transport::Message&& message) { return std::optional(std::move(message)); });
  }
  transport::EdgeState state() const override { return {}; }

 private:
  std::shared_ptr<MemoryLink> link_;
};

}  // namespace bodeflow::test
