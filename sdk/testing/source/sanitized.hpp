#pragma once

// BODEFLOW_SANITIZED is defined where a sanitizer owns the memory functions and the address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BODEFLOW_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define BODEFLOW_SANITIZED 1
#endif
#endif
