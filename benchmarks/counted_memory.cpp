// SPDX-License-Identifier: MIT
#include "counted_memory.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long long> g_held{0}, g_peak{0};

void* Counted(void* p) {
  if (p == nullptr) std::abort();
  const long long held = g_held += static_cast<long long>(malloc_usable_size(p));
  if (held > g_peak) g_peak = held;
  return p;
}
void Release(void* p) {
  g_held -= static_cast<long long>(malloc_usable_size(p));
  std::free(p);
}
}  // namespace

namespace crossnav {

long long MarkHeldBytes() {
  return g_peak = g_held.load();
}
long long PeakBytes() {
  return g_peak;
}

}  // namespace crossnav

void* operator new(std::size_t n) {
  return Counted(std::malloc(n));
}
void* operator new[](std::size_t n) {
  return Counted(std::malloc(n));
}
void* operator new(std::size_t n, std::align_val_t a) {
  const auto align = static_cast<std::size_t>(a);
  return Counted(std::aligned_alloc(align, (n + align - 1) / align * align));
}
void* operator new[](std::size_t n, std::align_val_t a) {
  return operator new(n, a);
}
void operator delete(void* p) noexcept {
  Release(p);
}
void operator delete[](void* p) noexcept {
  Release(p);
}
void operator delete(void* p, std::size_t) noexcept {
  Release(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  Release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  Release(p);
}
void operator delete[](void* p, std::align_val_t) noexcept {
  Release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  Release(p);
}
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
  Release(p);
}
