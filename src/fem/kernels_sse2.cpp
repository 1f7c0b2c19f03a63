// SPDX-License-Identifier: Apache-2.0
#if defined(__x86_64__)
#define RESECT_TARGET sse2
#define RESECT_WIDTH 4
#include "fem/kernel_source.inc"

const resect::Kernels resect::sse2_kernels = {"sse2", sse2::add_forces, sse2::move_nodes};
#endif
