// SPDX-License-Identifier: Apache-2.0
#if defined(__aarch64__)
#define RESECT_TARGET neon
#define RESECT_WIDTH 4
#include "fem/kernel_source.inc"

const resect::Kernels resect::neon_kernels = {"neon", neon::add_forces, neon::move_nodes};
#endif
