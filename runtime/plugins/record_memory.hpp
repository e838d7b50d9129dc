#pragma once

#include <bodeflow/abi.h>

#include <cstdint>

namespace bodeflow {

/// A record of `size` zero bytes, 64-byte aligned, with count 1; nullptr when there is no such memory. Any thread.
bf_record* record_create(std::uint64_t size) noexcept;
/// One count more. Any thread.
void record_retain(const bf_record* record) noexcept;
/// One count less; the last one gives the memory back. Any thread.
void record_release(const bf_record* record) noexcept;
/// Bytes that were asked for at its making: what a plugin wrote into `size` may be smaller, never larger.
std::uint64_t record_capacity(const bf_record* record) noexcept;

}  // namespace bodeflow
