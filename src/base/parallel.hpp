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
/// number of threads, so results need not either. Waiting threads spin for a moment, then sleep: idle workers
/// cost nothing.
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
    void take_chunks();
    void help();

    Call call_ = nullptr;
    void* task_ = nullptr;
    Index count_ = 0;
    std::atomic<Index> next_{0};
    std::atomic<std::uint32_t> job_{0};  // counts jobs
    std::atomic<std::uint32_t> busy_{0}; // helpers that have yet to finish the present job
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
