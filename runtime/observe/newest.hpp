#pragma once

#include <atomic>
#include <memory>

namespace bodeflow::observe {

/// The newest of what one thread gives, for another one that looks now and then. Neither waits for the other.
template <class T>
class Newest {
 public:
  Newest() = default;
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;
  ~Newest() { delete place_.load(); }

  void put(std::unique_ptr<T> value) { delete place_.exchange(value.release(), std::memory_order_acq_rel); }
  /// Nothing where none came since the last look.
  std::unique_ptr<T> take() { return std::unique_ptr<T>(place_.exchange(nullptr, std::memory_order_acq_rel)); }

 private:
  std::atomic<T*> place_{nullptr};
};

}  // namespace bodeflow::observe
