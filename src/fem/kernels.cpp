// SPDX-License-Identifier: Apache-2.0
#include "fem/kernels.hpp"

#include <array>

#include "fem/choose_kernels.hpp"

namespace resect {
namespace {

#if defined(__x86_64__)
bool runs_here(const Kernels& kernels) {
    __builtin_cpu_init();
    if (&kernels == &avx512_kernels) {
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma");
    }
    if (&kernels == &avx2_kernels) { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
    return true;
}
constexpr std::array<const Kernels*, 3> all = {&avx512_kernels, &avx2_kernels, &sse2_kernels};
#else
bool runs_here(const Kernels&) { return true; }
constexpr std::array<const Kernels*, 1> all = {&neon_kernels};
#endif

const Kernels*& chosen() {
    static const Kernels* kernels = find_kernels({});
    return kernels;
}

} // namespace

const Kernels* find_kernels(std::string_view name) {
    for (const Kernels* kernels : all) {
        if ((name.empty() || name == kernels->name) && runs_here(*kernels)) { return kernels; }
    }
    return nullptr;
}

const Kernels& kernels() { return *chosen(); }

bool choose_kernels(std::string_view name) {
    const Kernels* found = find_kernels(name);
    if (found != nullptr) { chosen() = found; }
    return found != nullptr;
}

} // namespace resect
