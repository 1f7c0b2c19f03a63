// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the hot loops read and write, as plain arrays: kernel files include this and no standard header, since
// what a file built for a newer processor emits of one may become the whole program's
// (scripts/check_kernels).
namespace resect {

inline constexpr int fan_lanes = 16;  // fans that a block walks side by side
inline constexpr int fan_longest = 8; // tets of one fan

/// A force as kernels see it; w is not used.
struct alignas(16) Row {
    float x, y, z, w;
};

/// A position in quanta, modulo 2^32: differences are exact wherever the body is. w is not used.
struct alignas(16) Place {
    int x, y, z, w;
};

inline constexpr float quanta_turn = 4294967296.0F; // 2^32
inline constexpr float round_adder = 12582912.0F;   // 1.5 * 2^23: what is added to it and taken off is whole

/// Towards zero; the least number for what is none or too large, as vectors have it.
inline int truncate(float x) {
    return x > -quanta_turn / 2 && x < quanta_turn / 2 ? static_cast<int>(x) : -2147483647 - 1;
}

/// A length in quanta, modulo 2^32; the number of quanta in a metre is a power of two.
inline int quanta(float length, float per_metre) {
    const float count = length * per_metre;
    const float turns = (count * (1 / quanta_turn) + round_adder) - round_adder;
    return truncate(count - quanta_turn * turns);
}

/// Rows of 16 fans, as byte offsets into the part's positions and forces.
struct alignas(64) FanNodes {
    unsigned at[fan_lanes];
};

/// What the law needs of 16 tets (a, b, c, d) with rest edges D = [b-a, c-a, d-a] in quanta of q metres; all
/// zero: no tet.
struct alignas(64) FanTets {
    float metric[6][fan_lanes];  // mu V / q (D^T D)^-1: 11, 22, 33, 12, 13, 23; N
    float inverse[fan_lanes];    // 1 / det D
    float resistance[fan_lanes]; // K V / q / det D, N
};

/// 16 fans of one length and material: tets (a, b, c_j, c_j+1) round the edges ab.
struct FanBlock {
    int length = 0, closed = 0;      // tets; 1: c_length is c_0
    int first_node = 0;              // row of a; b and c follow
    int first_tet = 0;               // row of tet 0
    float shear_over_resistance = 0; // mu / K
};

/// Tets that left the range of the kernel's law, by row of the fan and lane; the kernel gave them no force.
struct alignas(64) FansBeyond {
    int tet[fan_longest][fan_lanes]; // not 0: beyond
};

/// One part of the mesh.
struct FanArrays {
    const FanBlock* blocks;
    int block_count;
    const FanNodes* nodes;
    const FanTets* tets;
    const Place* position; // x + viscous_time v
    Row* force;            // N, added to
    void (*beyond)(void* caller, int block, const FansBeyond& tets);
    void* caller;
};

/// Nodes [begin, end) of the arrays of NodeArrays and Packing, begin a multiple of 8.
struct NodeRows {
    int begin, end;
    const int *first_slot, *next_slot;
    const Row* force;
    const Place* rest;
    Place* position;
    const float *displacement, *velocity, *load, *mass, *inverse_mass;
    float *next_displacement, *next_velocity;
    float time_step, damping, viscous_time, quanta_a_metre;
    float gravity[3];
};

/// Of the nodes of one call, over one step.
struct NodeSums {
    float internal_work, damping_work; // J
    float speed_squared;               // m^2/s^2, largest component; NaN where anything is not finite
};

struct Kernels {
    const char* name;
    void (*add_forces)(const FanArrays& arrays);
    NodeSums (*move_nodes)(const NodeRows& rows);
};

extern const Kernels sse2_kernels, avx2_kernels, avx512_kernels, neon_kernels; // those of this processor

} // namespace resect
