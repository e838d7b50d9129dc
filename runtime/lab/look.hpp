#pragma once

#include <mutex>
#include <optional>

#include "execute/access.hpp"

namespace bodeflow::lab {

/// A run as it stands, for another thread to see; nothing before it begins and after it has ended.
class Look final : public execute::Observer {
 public:
  void begins(execute::Access& access) override {
    const std::lock_guard lock(mutex_);
    access_ = &access;
  }
  void ends() override {
    const std::lock_guard lock(mutex_);
    access_ = nullptr;
  }
  std::optional<execute::State> state() const {
    const std::lock_guard lock(mutex_);
    if (access_ == nullptr) return std::nullopt;
    return access_->state();
  }

 private:
  mutable std::mutex mutex_;
  execute::Access* access_ = nullptr;
};

}  // namespace bodeflow::lab
