// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

namespace resect {

/// Ends the program: a precondition or an invariant of ours is broken, so nothing that follows could be
/// trusted.
[[noreturn]] inline void fail_assertion(const char* what, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: broken: %s\n", file, line, what);
    std::abort();
}

} // namespace resect

/// On where validators are on (preset dev, release-asserts and the sanitizers), off in release.
#ifdef RESECT_VERIFY
#define RESECT_ASSERT(condition)                                                                             \
    ((condition) ? static_cast<void>(0) : ::resect::fail_assertion(#condition, __FILE__, __LINE__))
#else
#define RESECT_ASSERT(condition) static_cast<void>(sizeof(condition))
#endif
