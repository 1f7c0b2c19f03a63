// SPDX-License-Identifier: Apache-2.0
#if defined(__x86_64__)
#define RESECT_TARGET avx2
#define RESECT_WIDTH 8
#include "fem/kernel_source.inc"

const resect::Kernels resect::avx2_kernels = {"avx2", avx2::add_forces, avx2::move_nodes};
#endif
