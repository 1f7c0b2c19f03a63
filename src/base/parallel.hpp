// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "resect/body.hpp"

namespace resect {

/// Threads that share the chunks of one job at a time. Chunks are the caller's and do not depend on the
/// number of threads, so results need not either. Each thread begins with chunks of its own, the same in
/// every job of one count, which keeps them in its cache, and then helps the others. Nobody waits for a
/// thread that has no chunk in hand. Waiting threads spin for a moment, then sleep: idle workers cost
/// nothing.
class Workers {
public:
    explicit Workers(int threads); // counting the caller's; 0: one a core
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// Calls task(chunk) once for each chunk in [0, count), in no order; back when all are done. Allocates
    /// nothing.
    template <class Task>
    void run(Index count, Task&& task) {
        using Plain = std::remove_reference_t<Task>;
        run_erased(
            count, [](void* erased, Index chunk) { (*static_cast<Plain*>(erased))(chunk); },
            const_cast<std::remove_const_t<Plain>*>(&task));
    }
    int threads() const { return static_cast<int>(helpers_.size()) + 1; }

private:
    using Call = void (*)(void* task, Index chunk);
    void run_erased(Index count, Call call, void* task);
    void take_chunks(std::size_t thread);
    void help(std::size_t thread);

    /// The chunks that a thread begins with.
    struct alignas(64) Own {
        std::atomic<Index> next{0};
        Index end = 0;
    };

    Call call_ = nullptr;
    void* task_ = nullptr;
    std::vector<Own> own_;                 // [thread], the caller's first
    std::atomic<std::uint32_t> job_{0};    // counts jobs
    std::atomic<std::uint32_t> inside_{0}; // helpers in the present job; its highest bit: they may enter
    std::atomic<bool> leaving_{false};
    std::vector<std::jthread> helpers_;
};

/// Chunk `chunk` of [0, count) when chunks hold `size` rows.
inline std::pair<Index, Index> chunk_range(Index chunk, Index size, Index count) {
    const Index begin = chunk * size;
    return {begin, begin + size < count ? begin + size : count};
}
inline Index chunk_count(Index size, Index count) { return (count + size - 1) / size; }

} // namespace resect
