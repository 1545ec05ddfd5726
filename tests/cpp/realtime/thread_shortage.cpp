#include "realtime/thread_shortage.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>

namespace {

constexpr int kNoShortage = -1;
thread_local int threads_left = kNoShortage;

using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);

}  // namespace

// Found before the C library's, and before that of a sanitizer, which it calls.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*start)(void*), void* argument) {
  if (threads_left == 0) return EAGAIN;
  if (threads_left > 0) --threads_left;
  static auto* const create = reinterpret_cast<Create*>(dlsym(RTLD_NEXT, "pthread_create"));
  return create(thread, attributes, start, argument);
}

namespace viapoint {

ThreadShortage::ThreadShortage(int allowed) { threads_left = allowed; }

ThreadShortage::~ThreadShortage() { threads_left = kNoShortage; }

}  // namespace viapoint
