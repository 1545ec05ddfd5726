/// @file
/// Marks what runs in the real-time thread, so that RealtimeSanitizer (clang 20 or newer,
/// -fsanitize=realtime) stops at any heap, lock or system call below it. Goes after noexcept.
#pragma once

#if defined(__clang__) && defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#define VIAPOINT_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef VIAPOINT_NONBLOCKING
#define VIAPOINT_NONBLOCKING
#endif
