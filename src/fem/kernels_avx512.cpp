// SPDX-License-Identifier: Apache-2.0
#if defined(__x86_64__)
#define RESECT_TARGET avx512
#define RESECT_WIDTH 16
#include "fem/kernel_source.inc"

const resect::Kernels resect::avx512_kernels = {"avx512", avx512::add_forces, avx512::move_nodes};
#endif
