// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.hpp"

#include <algorithm>
#include <system_error>

namespace resect {

namespace {

// About as long as a step of a small body leaves between two jobs; longer waits sleep.
constexpr int spins = 4000;

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

} // namespace

Workers::Workers(int threads) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const int wanted = threads > 0 ? std::min(threads, 256) : cores;
    helpers_.reserve(static_cast<std::size_t>(wanted - 1));
    try {
        for (int i = 1; i < wanted; ++i) {
            helpers_.emplace_back([this] { help(); });
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

void Workers::take_chunks() {
    for (Index chunk = next_.fetch_add(1, std::memory_order_relaxed); chunk < count_;
         chunk = next_.fetch_add(1, std::memory_order_relaxed)) {
        call_(task_, chunk);
    }
}

void Workers::help() {
    for (std::uint32_t seen = 0;;) {
        seen = wait_for_change(job_, seen);
        if (leaving_.load(std::memory_order_relaxed)) { return; }
        take_chunks();
        if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) { busy_.notify_one(); }
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
    count_ = count;
    next_.store(0, std::memory_order_relaxed);
    busy_.store(static_cast<std::uint32_t>(helpers_.size()), std::memory_order_relaxed);
    job_.fetch_add(1, std::memory_order_release);
    job_.notify_all();
    take_chunks();
    for (std::uint32_t left = busy_.load(std::memory_order_acquire); left != 0;) {
        left = wait_for_change(busy_, left);
    }
}

} // namespace resect
