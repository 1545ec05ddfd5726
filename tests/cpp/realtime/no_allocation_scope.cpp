#include "realtime/no_allocation_scope.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

thread_local bool counting = false;
thread_local std::uint64_t count = 0;

void note() {
  if (counting) ++count;
}

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Below operator new too: Eigen calls malloc itself. Sanitizers bring their own malloc, so there
// only operator new is watched.
extern "C" {
// The C library's own names for what stands behind malloc and the rest.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void __libc_free(void* block);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  note();
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) {
  note();
  return __libc_realloc(block, size);
}
void free(void* block) {
  if (block != nullptr) note();
  __libc_free(block);
}
}
#endif

void* operator new(std::size_t size) {
  note();
  if (void* block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  note();
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* block) noexcept {
  if (block != nullptr) note();
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
  if (block != nullptr) note();
  std::free(block);
}

namespace viapoint {

NoAllocationScope::NoAllocationScope() {
  count = 0;
  counting = true;
}
NoAllocationScope::~NoAllocationScope() { counting = false; }
std::uint64_t NoAllocationScope::calls() const { return count; }

}  // namespace viapoint
