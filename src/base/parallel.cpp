// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.hpp"

#include <algorithm>
#include <system_error>

namespace resect {

namespace {

// About as long as a step of a small body leaves between two jobs; longer waits sleep.
constexpr int spins = 4000;
constexpr std::uint32_t open = std::uint32_t{1} << 31U;

void pause_briefly() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#else
    std::this_thread::yield();
#endif
}

/// Waits until `value` differs from `old`: spinning first, then asleep.
std::uint32_t wait_for_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
    for (int spin = 0; spin < spins; ++spin) {
        const std::uint32_t now = value.load(std::memory_order_acquire);
        if (now != old) { return now; }
        pause_briefly();
    }
    value.wait(old, std::memory_order_acquire);
    return value.load(std::memory_order_acquire);
}

int count_threads(int wanted) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return wanted > 0 ? std::min(wanted, 256) : cores;
}

} // namespace

Workers::Workers(int threads) : own_(static_cast<std::size_t>(count_threads(threads))) {
    helpers_.reserve(own_.size() - 1);
    try {
        for (std::size_t thread = 1; thread < own_.size(); ++thread) {
            helpers_.emplace_back([this, thread] { help(thread); });
        }
    } catch (const std::system_error&) {
        // The machine gives no more threads: fewer do the same work.
    }
}

Workers::~Workers() {
    leaving_.store(true, std::memory_order_relaxed);
    job_.fetch_add(1, std::memory_order_release);
    job_.notify_all();
}

void Workers::take_chunks(std::size_t thread) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
        Own& own = own_[(thread + i) % own_.size()];
        for (Index chunk = own.next.fetch_add(1, std::memory_order_relaxed); chunk < own.end;
             chunk = own.next.fetch_add(1, std::memory_order_relaxed)) {
            call_(task_, chunk);
        }
    }
}

void Workers::help(std::size_t thread) {
    for (std::uint32_t seen = 0;;) {
        seen = wait_for_change(job_, seen);
        if (leaving_.load(std::memory_order_relaxed)) { return; }
        if ((inside_.fetch_add(1, std::memory_order_acquire) & open) != 0) { take_chunks(thread); }
        if (inside_.fetch_sub(1, std::memory_order_acq_rel) == 1) { inside_.notify_one(); }
    }
}

void Workers::run_erased(Index count, Call call, void* task) {
    if (helpers_.empty() || count <= 1) {
        for (Index chunk = 0; chunk < count; ++chunk) {
            call(task, chunk);
        }
        return;
    }
    call_ = call;
    task_ = task;
    const auto threads = static_cast<Index>(own_.size());
    for (Index thread = 0; thread < threads; ++thread) {
        const auto begin = [&](std::int64_t t) { return static_cast<Index>(t * count / threads); };
        Own& own = own_[static_cast<std::size_t>(thread)];
        own.end = begin(thread + 1);
        own.next.store(begin(thread), std::memory_order_relaxed);
    }
    inside_.fetch_or(open, std::memory_order_release);
    job_.fetch_add(1, std::memory_order_release);
    job_.notify_all();
    take_chunks(0);
    std::uint32_t left = inside_.fetch_and(~open, std::memory_order_acq_rel) & ~open;
    while (left != 0) {
        left = wait_for_change(inside_, left);
    }
}

} // namespace resect
