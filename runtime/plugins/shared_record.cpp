#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "plugins/instance.hpp"
#include "plugins/record_memory.hpp"

namespace bodeflow {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::uint64_t kLargest = std::uint64_t{1}
                                   << 46U;  // beyond any address space in use: keeps the sums below from wrapping

/// Stands before a record's bytes, in one piece of memory with them.
struct alignas(kAlignment) Header {
  bf_record record{};
  std::atomic<std::uint32_t> count{1};
  std::uint64_t capacity = 0;
};
static_assert(sizeof(Header) == kAlignment);

Header* header_of(const bf_record* record) {
  // The ABI hands records out as const; the count is the host's own.
  return reinterpret_cast<Header*>(const_cast<bf_record*>(record));
}

}  // namespace

bf_record* record_create(std::uint64_t size) noexcept {
  if (size > kLargest) return nullptr;
  const std::size_t padded = (static_cast<std::size_t>(size) + kAlignment - 1) / kAlignment * kAlignment;
  void* memory = std::aligned_alloc(kAlignment, sizeof(Header) + padded);
  if (memory == nullptr) return nullptr;
  auto* header = new (memory) Header;
  header->record.bytes = static_cast<std::uint8_t*>(memory) + sizeof(Header);
  header->record.size = size;
  header->capacity = size;
  std::memset(header->record.bytes, 0, padded);
  return &header->record;
}

void record_retain(const bf_record* record) noexcept {
  if (record != nullptr) header_of(record)->count.fetch_add(1, std::memory_order_relaxed);
}

void record_release(const bf_record* record) noexcept {
  if (record == nullptr) return;
  Header* header = header_of(record);
  if (header->count.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  header->~Header();
  std::free(header);
}

std::uint64_t record_capacity(const bf_record* record) noexcept { return header_of(record)->capacity; }

SharedRecord SharedRecord::adopt(const bf_record* record) {
  SharedRecord shared;
  shared.record_ = record;
  return shared;
}

SharedRecord SharedRecord::copy(const void* bytes, std::size_t size) {
  bf_record* record = record_create(size);
  if (record == nullptr) throw std::bad_alloc();
  if (size > 0) std::memcpy(record->bytes, bytes, size);
  return adopt(record);
}

SharedRecord::SharedRecord(const SharedRecord& other) : record_(other.record_) { record_retain(record_); }

SharedRecord::SharedRecord(SharedRecord&& other) noexcept : record_(std::exchange(other.record_, nullptr)) {}

SharedRecord& SharedRecord::operator=(SharedRecord other) noexcept {
  std::swap(record_, other.record_);
  return *this;
}

SharedRecord::~SharedRecord() { record_release(record_); }

const std::uint8_t* SharedRecord::bytes() const {
  return record_ == nullptr ? nullptr : reinterpret_cast<const std::uint8_t*>(header_of(record_) + 1);
}

std::size_t SharedRecord::size() const {
  return record_ == nullptr ? 0 : static_cast<std::size_t>(std::min(record_->size, record_capacity(record_)));
}

}  // namespace bodeflow
