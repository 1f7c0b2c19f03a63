// SPDX-License-Identifier: Apache-2.0
// The hot loops, included once for each target by a file that names RESECT_TARGET and RESECT_WIDTH, the lanes
// that it walks side by side. Each target gives the same bits: sums run in the order that scatter() says, and
// every fused multiply-add is written out.
#include "fem/kernels.hpp"

namespace resect::RESECT_TARGET {
namespace {

template <int W>
struct VectorOf {
    using Float [[gnu::vector_size(4 * W)]] = float;
    using Int [[gnu::vector_size(4 * W)]] = int;
    using FloatsAt [[gnu::vector_size(4 * W), gnu::may_alias]] = float; // in arrays of float
    using IntsAt [[gnu::vector_size(4 * W), gnu::may_alias]] = int;
    using FloatsAnywhere [[gnu::vector_size(4 * W), gnu::may_alias, gnu::aligned(4)]] = float;
};
constexpr int width = RESECT_WIDTH;
using V = VectorOf<width>::Float;
using Mask = VectorOf<width>::Int;
using V4 = VectorOf<4>::Float;
using D2 [[gnu::vector_size(16)]] = double;
using M2 [[gnu::vector_size(16)]] = long long;
using VAt = VectorOf<width>::FloatsAt;
using MaskAt = VectorOf<width>::IntsAt;
using M4 = VectorOf<4>::Int;
using V4At = VectorOf<4>::FloatsAt;
using M4At = VectorOf<4>::IntsAt;

struct V3 {
    V x, y, z;
};
struct Places {
    Mask x, y, z;
};

#define RESECT_INLINE [[gnu::always_inline]] inline

// One rounding. The lane loop says it all, but g++ 12 makes scalars of some of them.
#if RESECT_WIDTH == 8 && !defined(__clang__)
RESECT_INLINE V fma(V a, V b, V c) { return __builtin_ia32_vfmaddps256(a, b, c); }
#elif RESECT_WIDTH == 16 && !defined(__clang__)
RESECT_INLINE V fma(V a, V b, V c) { return __builtin_ia32_vfmaddps512_mask(a, b, c, -1, 4); }
#elif defined(__SSE2__) && !defined(__FMA__)
/// The product is exact in double; the sum is rounded to odd, so that rounding it to float rounds as if once
/// (Boldo and Melquiond 2008).
RESECT_INLINE D2 multiply_add(D2 a, D2 b, D2 c) {
    const D2 product = a * b, sum = product + c, part = sum - product;
    const D2 error = (product - (sum - part)) + (c - part);
    const M2 bits = reinterpret_cast<M2>(sum);
    const M2 is_even = (bits & 1) - 1, is_inexact = (error > 0) | (error < 0);
    const M2 step = ((error > 0) ^ (sum > 0)) | 1;
    return reinterpret_cast<D2>(bits + (is_even & is_inexact & step));
}
RESECT_INLINE D2 low(V v) { return __builtin_convertvector(__builtin_shufflevector(v, v, 0, 1), D2); }
RESECT_INLINE D2 high(V v) { return __builtin_convertvector(__builtin_shufflevector(v, v, 2, 3), D2); }
RESECT_INLINE V fma(V a, V b, V c) {
    using V2 = VectorOf<2>::Float;
    return __builtin_shufflevector(__builtin_convertvector(multiply_add(low(a), low(b), low(c)), V2),
                                   __builtin_convertvector(multiply_add(high(a), high(b), high(c)), V2), 0, 1,
                                   2, 3);
}
#else
RESECT_INLINE V fma(V a, V b, V c) {
    V sum;
    for (int lane = 0; lane < width; ++lane) {
        sum[lane] = __builtin_fmaf(a[lane], b[lane], c[lane]);
    }
    return sum;
}
#endif
RESECT_INLINE V load(const float* from) { return *reinterpret_cast<const VAt*>(from); }
RESECT_INLINE V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
RESECT_INLINE V3 operator-(V3 a) { return {-a.x, -a.y, -a.z}; }
RESECT_INLINE V3 scaled(V s, V3 a) { return {s * a.x, s * a.y, s * a.z}; }
RESECT_INLINE V3 fma(V s, V3 a, V3 b) { return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)}; }
RESECT_INLINE V dot(V3 a, V3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }
RESECT_INLINE V3 cross(V3 a, V3 b) {
    return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}

// Rows to lanes and back: blocks of 4 by 4, of which one lies in each 128 bits of a vector.
RESECT_INLINE V4 get_row(const Row* row) { return *reinterpret_cast<const V4At*>(row); }
RESECT_INLINE void put_row(Row* row, V4 value) { *reinterpret_cast<V4At*>(row) = value; }
RESECT_INLINE M4 get_place(const Place* place) { return *reinterpret_cast<const M4At*>(place); }
RESECT_INLINE void put_place(Place* place, M4 value) { *reinterpret_cast<M4At*>(place) = value; }
RESECT_INLINE M4 place_at(const Place* places, unsigned offset) {
    return get_place(reinterpret_cast<const Place*>(reinterpret_cast<const char*>(places) + offset));
}
RESECT_INLINE void add_at(Row* rows, unsigned offset, V4 value) {
    Row* row = reinterpret_cast<Row*>(reinterpret_cast<char*>(rows) + offset);
    put_row(row, get_row(row) + value);
}

#if RESECT_WIDTH == 4
#define RESECT_LANES(i0, i1, i2, i3) i0, i1, i2, i3
RESECT_INLINE Mask join(const Place* places, const unsigned* at) { return place_at(places, at[0]); }
template <int Q>
RESECT_INLINE V4 quarter(V v) {
    return v;
}
#elif RESECT_WIDTH == 8
#define RESECT_LANES(i0, i1, i2, i3)                                                                         \
    (i0) + ((i0) / 4) * 4, (i1) + ((i1) / 4) * 4, (i2) + ((i2) / 4) * 4, (i3) + ((i3) / 4) * 4,              \
        (i0) + ((i0) / 4) * 4 + 4, (i1) + ((i1) / 4) * 4 + 4, (i2) + ((i2) / 4) * 4 + 4,                     \
        (i3) + ((i3) / 4) * 4 + 4
RESECT_INLINE Mask join(const Place* places, const unsigned* at) {
    return __builtin_shufflevector(place_at(places, at[0]), place_at(places, at[4]), 0, 1, 2, 3, 4, 5, 6, 7);
}
template <int Q>
RESECT_INLINE V4 quarter(V v) {
    return __builtin_shufflevector(v, v, 4 * Q, 4 * Q + 1, 4 * Q + 2, 4 * Q + 3);
}
#else
#define RESECT_WIDE(i) (i) + ((i) / 4) * 12
#define RESECT_LANES(i0, i1, i2, i3)                                                                         \
    RESECT_WIDE(i0), RESECT_WIDE(i1), RESECT_WIDE(i2), RESECT_WIDE(i3), RESECT_WIDE(i0) + 4,                 \
        RESECT_WIDE(i1) + 4, RESECT_WIDE(i2) + 4, RESECT_WIDE(i3) + 4, RESECT_WIDE(i0) + 8,                  \
        RESECT_WIDE(i1) + 8, RESECT_WIDE(i2) + 8, RESECT_WIDE(i3) + 8, RESECT_WIDE(i0) + 12,                 \
        RESECT_WIDE(i1) + 12, RESECT_WIDE(i2) + 12, RESECT_WIDE(i3) + 12
RESECT_INLINE Mask join(const Place* places, const unsigned* at) {
    const auto low =
        __builtin_shufflevector(place_at(places, at[0]), place_at(places, at[4]), 0, 1, 2, 3, 4, 5, 6, 7);
    const auto high =
        __builtin_shufflevector(place_at(places, at[8]), place_at(places, at[12]), 0, 1, 2, 3, 4, 5, 6, 7);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
template <int Q>
RESECT_INLINE V4 quarter(V v) {
    return __builtin_shufflevector(v, v, 4 * Q, 4 * Q + 1, 4 * Q + 2, 4 * Q + 3);
}
#endif

RESECT_INLINE Places gather(const Place* places, const unsigned* at) {
    const Mask r0 = join(places, at), r1 = join(places, at + 1);
    const Mask r2 = join(places, at + 2), r3 = join(places, at + 3);
    const Mask xy01 = __builtin_shufflevector(r0, r1, RESECT_LANES(0, 4, 1, 5));
    const Mask xy23 = __builtin_shufflevector(r2, r3, RESECT_LANES(0, 4, 1, 5));
    const Mask z01 = __builtin_shufflevector(r0, r1, RESECT_LANES(2, 6, 3, 7));
    const Mask z23 = __builtin_shufflevector(r2, r3, RESECT_LANES(2, 6, 3, 7));
    return {__builtin_shufflevector(xy01, xy23, RESECT_LANES(0, 1, 4, 5)),
            __builtin_shufflevector(xy01, xy23, RESECT_LANES(2, 3, 6, 7)),
            __builtin_shufflevector(z01, z23, RESECT_LANES(0, 1, 4, 5))};
}

/// In quanta, each rounded once.
RESECT_INLINE V3 edge(Places to, Places from) {
    return {__builtin_convertvector(to.x - from.x, V), __builtin_convertvector(to.y - from.y, V),
            __builtin_convertvector(to.z - from.z, V)};
}

template <int Q>
RESECT_INLINE void scatter_quarter(Row* rows, const unsigned* at, V r0, V r1, V r2, V r3) {
    add_at(rows, at[4 * Q], quarter<Q>(r0));
    add_at(rows, at[4 * Q + 1], quarter<Q>(r1));
    add_at(rows, at[4 * Q + 2], quarter<Q>(r2));
    add_at(rows, at[4 * Q + 3], quarter<Q>(r3));
}

/// Lane after lane, so that lanes may share nodes.
RESECT_INLINE void scatter(Row* rows, const unsigned* at, V3 f) {
    const V zero = {};
    const V xy02 = __builtin_shufflevector(f.x, f.y, RESECT_LANES(0, 4, 1, 5));
    const V xy13 = __builtin_shufflevector(f.x, f.y, RESECT_LANES(2, 6, 3, 7));
    const V z02 = __builtin_shufflevector(f.z, zero, RESECT_LANES(0, 4, 1, 5));
    const V z13 = __builtin_shufflevector(f.z, zero, RESECT_LANES(2, 6, 3, 7));
    const V r0 = __builtin_shufflevector(xy02, z02, RESECT_LANES(0, 1, 4, 5));
    const V r1 = __builtin_shufflevector(xy02, z02, RESECT_LANES(2, 3, 6, 7));
    const V r2 = __builtin_shufflevector(xy13, z13, RESECT_LANES(0, 1, 4, 5));
    const V r3 = __builtin_shufflevector(xy13, z13, RESECT_LANES(2, 3, 6, 7));
    scatter_quarter<0>(rows, at, r0, r1, r2, r3);
    if constexpr (width >= 8) { scatter_quarter<1>(rows, at, r0, r1, r2, r3); }
}

// The law in its range J >= 0.6, I1 <= 6, which lies inside the trusted one (fem/law.hpp): I2 <= I1^2 / 3.
constexpr float least_volume = 0.6F, largest_length = 6;

/// J^(-1/3) for J of 0.6 to 2.83, relative error below 1e-7: a cubic within 6e-3 and one step of Halley's
/// kind.
RESECT_INLINE V inverse_cube_root(V J) {
    const V one = V{} + 1;
    const V start =
        fma(fma(fma(V{} - 0.04676055F, J, V{} + 0.32897217F), J, V{} - 0.87105295F), J, V{} + 1.59313076F);
    const V error = fma(-(J * start), start * start, one);
    return fma(start * error, fma(error, V{} + 2.0F / 9, V{} + 1.0F / 3), start);
}

/// Forces of a tet on b, c and d are a A + b cof, where A = mu V F D^-T and cof = cof [b-a, c-a, d-a].
struct Factors {
    V a, b;
    Mask beyond;
};

RESECT_INLINE Factors neo_hookean(V determinant, V length, V inverse, V resistance, V bound) {
    const V J = determinant * inverse;
    const V root = inverse_cube_root(J);
    const V phi = root * root;
    const V scaled_length = length * inverse;
    const V pressure = phi * phi * root * (scaled_length * (1.0F / 3));
    const V b = fma(resistance, J - 1, -pressure);
    const Mask beyond = (((least_volume - J) * resistance) > 0) | (scaled_length > bound * resistance);
    return {beyond ? V{} : phi, beyond ? V{} : b, beyond};
}

/// Forces by row of the fan's nodes, of lanes that wait to be scattered.
struct alignas(64) Lanes3 {
    float x[fan_lanes], y[fan_lanes], z[fan_lanes];
};

RESECT_INLINE void put(Lanes3& to, int lane, V3 value) {
    *reinterpret_cast<VAt*>(to.x + lane) = value.x;
    *reinterpret_cast<VAt*>(to.y + lane) = value.y;
    *reinterpret_cast<VAt*>(to.z + lane) = value.z;
}
RESECT_INLINE V3 get(const Lanes3& from, int lane) {
    return {load(from.x + lane), load(from.y + lane), load(from.z + lane)};
}

/// Walks fans `lane` to `lane + width`: each tet needs one new node; two edges, a cross product and the
/// forces on a, b and c carry over from the tet before.
template <bool closed>
RESECT_INLINE Mask walk(const Place* position, const FanNodes* nodes, const FanTets* tets, int length,
                        float bound, int lane, Lanes3* force, FansBeyond& beyond) {
    const Places a = gather(position, nodes[0].at + lane);
    const V3 e1 = edge(gather(position, nodes[1].at + lane), a);
    const V3 first = edge(gather(position, nodes[2].at + lane), a);
    V3 e2 = first, k3 = cross(e1, e2), on_b = {}, on_c = {}, on_others = {};
    Mask any = {};
    put(force[2], lane, on_c);
    for (int j = 0; j < length; ++j) {
        const FanTets& tet = tets[j];
        const V3 e3 = closed && j == length - 1 ? first : edge(gather(position, nodes[3 + j].at + lane), a);
        const V g11 = load(tet.metric[0] + lane), g22 = load(tet.metric[1] + lane);
        const V g33 = load(tet.metric[2] + lane), g12 = load(tet.metric[3] + lane);
        const V g13 = load(tet.metric[4] + lane), g23 = load(tet.metric[5] + lane);
        const V3 k1 = cross(e2, e3), k2 = cross(e3, e1);
        const V3 A1 = fma(g13, e3, fma(g12, e2, scaled(g11, e1)));
        const V3 A2 = fma(g23, e3, fma(g22, e2, scaled(g12, e1)));
        const V3 A3 = fma(g33, e3, fma(g23, e2, scaled(g13, e1)));
        const V length_scaled = dot(e1, A1) + (dot(e2, A2) + dot(e3, A3));
        const Factors law = neo_hookean(dot(e1, k1), length_scaled, load(tet.inverse + lane),
                                        load(tet.resistance + lane), V{} + bound);
        on_b = fma(law.b, k1, fma(law.a, A1, on_b));
        on_c = fma(law.b, k2, fma(law.a, A2, on_c));
        put(force[2 + j], lane, on_c);
        on_others = on_others + on_c;
        on_c = fma(law.b, k3, scaled(law.a, A3));
        *reinterpret_cast<MaskAt*>(beyond.tet[j] + lane) = law.beyond;
        any |= law.beyond;
        k3 = -k2;
        e2 = e3;
    }
    if (closed) {
        put(force[2], lane, get(force[2], lane) + on_c);
    } else {
        put(force[2 + length], lane, on_c);
    }
    put(force[0], lane, -(on_b + (on_others + on_c)));
    put(force[1], lane, on_b);
    return any;
}

RESECT_INLINE bool is_any(Mask mask) {
    int any = 0;
    for (int lane = 0; lane < width; ++lane) {
        any |= mask[lane];
    }
    return any != 0;
}

/// Adds up forces in halves of eight lanes, whatever the width.
RESECT_INLINE void scatter_half(Row* rows, const FanNodes* nodes, int count, int half, const Lanes3* force) {
    constexpr int step = width < 8 ? width : 8;
    for (int node = 0; node < count; ++node) {
        for (int lane = 8 * half; lane < 8 * half + 8; lane += step) {
#if RESECT_WIDTH == 16
            const V3 f = get(force[node], 0);
            const V3 moved = half == 0 ? f
                                       : V3{__builtin_shufflevector(f.x, f.x, 8, 9, 10, 11, 12, 13, 14, 15, 8,
                                                                    9, 10, 11, 12, 13, 14, 15),
                                            __builtin_shufflevector(f.y, f.y, 8, 9, 10, 11, 12, 13, 14, 15, 8,
                                                                    9, 10, 11, 12, 13, 14, 15),
                                            __builtin_shufflevector(f.z, f.z, 8, 9, 10, 11, 12, 13, 14, 15, 8,
                                                                    9, 10, 11, 12, 13, 14, 15)};
            scatter(rows, nodes[node].at + lane, moved);
#else
            scatter(rows, nodes[node].at + lane, get(force[node], lane));
#endif
        }
    }
}

template <bool closed>
RESECT_INLINE void add_block(const FanArrays& arrays, int index) {
    const FanBlock& block = arrays.blocks[index];
    const FanNodes* nodes = arrays.nodes + block.first_node;
    const FanTets* tets = arrays.tets + block.first_tet;
    const float bound = largest_length * block.shear_over_resistance;
    const int count = block.length + (closed ? 2 : 3);
    Lanes3 force[fan_longest + 3];
    FansBeyond beyond;
    Mask any = {};
    for (int lane = 0; lane < fan_lanes; lane += width) {
        any |= walk<closed>(arrays.position, nodes, tets, block.length, bound, lane, force, beyond);
        if constexpr (width >= 8) {
            for (int half = lane / 8; half < (lane + width) / 8; ++half) {
                scatter_half(arrays.force, nodes, count, half, force);
            }
        } else if (lane % 8 == 4) {
            scatter_half(arrays.force, nodes, count, lane / 8, force);
        }
    }
    if (is_any(any)) { arrays.beyond(arrays.caller, index, beyond); }
}

void add_forces(const FanArrays& arrays) {
    for (int block = 0; block < arrays.block_count; ++block) {
        if (arrays.blocks[block].closed != 0) {
            add_block<true>(arrays, block);
        } else {
            add_block<false>(arrays, block);
        }
    }
}

// Nodes, eight side by side on every target: their 24 numbers are three vectors.
using V8 = VectorOf<8>::Float;
using M8 = VectorOf<8>::Int;
using V8At = VectorOf<8>::FloatsAnywhere;

struct Floats24 {
    V8 at[3];
};
struct Quanta24 {
    M8 at[3];
};

RESECT_INLINE V8 join(V4 low, V4 high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
RESECT_INLINE M4 low_half(M8 v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
RESECT_INLINE M4 high_half(M8 v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }

RESECT_INLINE V8 load_8(const float* from) { return *reinterpret_cast<const V8At*>(from); }
RESECT_INLINE Floats24 load_24(const float* from) {
    return {{load_8(from), load_8(from + 8), load_8(from + 16)}};
}
RESECT_INLINE void store_24(float* to, const Floats24& values, int count) {
    if (count == 24) {
        for (int i = 0; i < 3; ++i) {
            *reinterpret_cast<V8At*>(to + 8 * i) = values.at[i];
        }
        return;
    }
    for (int i = 0; i < count; ++i) {
        to[i] = values.at[i / 8][i % 8];
    }
}
RESECT_INLINE Floats24 flatten(const V4 (&r)[8]) {
    const V4 a = __builtin_shufflevector(r[0], r[1], 0, 1, 2, 4),
             b = __builtin_shufflevector(r[1], r[2], 1, 2, 4, 5);
    const V4 c = __builtin_shufflevector(r[2], r[3], 2, 4, 5, 6),
             d = __builtin_shufflevector(r[4], r[5], 0, 1, 2, 4);
    const V4 e = __builtin_shufflevector(r[5], r[6], 1, 2, 4, 5),
             f = __builtin_shufflevector(r[6], r[7], 2, 4, 5, 6);
    return {{join(a, b), join(c, d), join(e, f)}};
}
/// The w of the rows is anything.
RESECT_INLINE void unflatten(M4 (&rows)[8], const Quanta24& from) {
    const M4 a = low_half(from.at[0]), b = high_half(from.at[0]), c = low_half(from.at[1]);
    const M4 d = high_half(from.at[1]), e = low_half(from.at[2]), f = high_half(from.at[2]);
    rows[0] = a;
    rows[1] = __builtin_shufflevector(a, b, 3, 4, 5, 5);
    rows[2] = __builtin_shufflevector(b, c, 2, 3, 4, 4);
    rows[3] = __builtin_shufflevector(c, c, 1, 2, 3, 3);
    rows[4] = d;
    rows[5] = __builtin_shufflevector(d, e, 3, 4, 5, 5);
    rows[6] = __builtin_shufflevector(e, f, 2, 3, 4, 4);
    rows[7] = __builtin_shufflevector(f, f, 1, 2, 3, 3);
}
/// One number of each node as three.
RESECT_INLINE Floats24 thrice(V8 v) {
    return {{__builtin_shufflevector(v, v, 0, 0, 0, 1, 1, 1, 2, 2),
             __builtin_shufflevector(v, v, 2, 3, 3, 3, 4, 4, 4, 5),
             __builtin_shufflevector(v, v, 5, 5, 6, 6, 6, 7, 7, 7)}};
}

struct EightNodes {
    Floats24 displacement, velocity, load, force, mass, inverse_mass;
};

RESECT_INLINE V4 internal_force(const NodeRows& rows, int node) {
    V4 sum = {};
    for (int slot = rows.first_slot[node]; slot >= 0; slot = rows.next_slot[slot]) {
        sum += get_row(rows.force + slot);
    }
    return sum;
}

RESECT_INLINE EightNodes load_eight(const NodeRows& rows, int node) {
    V4 force[8];
    for (int i = 0; i < 8; ++i) {
        force[i] = internal_force(rows, node + i);
    }
    return {load_24(rows.displacement + 3 * node), load_24(rows.velocity + 3 * node),
            load_24(rows.load + 3 * node),         flatten(force),
            thrice(load_8(rows.mass + node)),      thrice(load_8(rows.inverse_mass + node))};
}

/// The last ones, fewer than eight, beside nodes that are held at rest.
[[gnu::noinline]] EightNodes load_last(const NodeRows& rows, int node) {
    const int count = rows.end - node;
    float flat[3][24] = {}, mass[8] = {}, inverse_mass[8] = {};
    V4 force[8] = {};
    for (int i = 0; i < count; ++i) {
        force[i] = internal_force(rows, node + i);
        mass[i] = rows.mass[node + i];
        inverse_mass[i] = rows.inverse_mass[node + i];
    }
    for (int i = 0; i < 3 * count; ++i) {
        flat[0][i] = rows.displacement[3 * node + i];
        flat[1][i] = rows.velocity[3 * node + i];
        flat[2][i] = rows.load[3 * node + i];
    }
    return {load_24(flat[0]), load_24(flat[1]),     load_24(flat[2]),
            flatten(force),   thrice(load_8(mass)), thrice(load_8(inverse_mass))};
}

struct EightSums {
    V8 internal, damping, speed_squared, sound; // sound: 0, or NaN where anything is not finite
};

/// Central differences in leapfrog form: M a + alpha M v = R - f with v at the half steps gives
/// v+ = c1 v- + c2 ((load - f) / m + g) and u+ = u + dt v+, where c2 = dt / (1 + alpha dt / 2) and
/// c1 = (1 - alpha dt / 2) / (1 + alpha dt / 2) = 1 - alpha c2; the last form rounds least.
/// A node without inverse mass goes on as it is: its velocity and displacement are the caller's.
RESECT_INLINE void move_eight(EightNodes& eight, EightSums& sums, const NodeRows& rows, float c2) {
    const float x = rows.gravity[0], y = rows.gravity[1], z = rows.gravity[2];
    const V8 gravity[3] = {{x, y, z, x, y, z, x, y}, {z, x, y, z, x, y, z, x}, {y, z, x, y, z, x, y, z}};
    for (int i = 0; i < 3; ++i) {
        const V8 before = eight.velocity.at[i], force = eight.force.at[i],
                 inverse_mass = eight.inverse_mass.at[i];
        const M8 is_free = inverse_mass > 0;
        const V8 push = inverse_mass * (eight.load.at[i] - force) + gravity[i];
        const V8 after = before + (is_free ? c2 * (push - rows.damping * before) : V8{});
        const V8 drift = is_free ? after : V8{};
        const V8 displacement = eight.displacement.at[i] + rows.time_step * drift;
        const V8 twice_mean = before + after, squared = drift * drift;
        sums.internal += force * twice_mean;
        sums.damping += (is_free ? eight.mass.at[i] * twice_mean : V8{}) * twice_mean;
        sums.speed_squared = squared > sums.speed_squared ? squared : sums.speed_squared;
        sums.sound += (displacement - displacement) + (after - after);
        eight.velocity.at[i] = after;
        eight.displacement.at[i] = displacement;
    }
}

/// Where the law is evaluated next: at x + viscous_time v; as place_at() (fem/packing) says of one node.
RESECT_INLINE void place_eight(const NodeRows& rows, int node, int count, const EightNodes& eight) {
    Quanta24 ahead;
    for (int i = 0; i < 3; ++i) {
        const V8 displacement = eight.displacement.at[i] * rows.quanta_a_metre;
        const V8 turns = (displacement * (1 / quanta_turn) + round_adder) - round_adder;
        const V8 offset = rows.viscous_time * eight.velocity.at[i] * rows.quanta_a_metre;
        ahead.at[i] = __builtin_convertvector(displacement - quanta_turn * turns, M8) +
                      __builtin_convertvector(offset, M8);
    }
    M4 at[8];
    unflatten(at, ahead);
    for (int i = 0; i < count; ++i) {
        for (int slot = rows.first_slot[node + i]; slot >= 0; slot = rows.next_slot[slot]) {
            put_place(rows.position + slot, get_place(rows.rest + slot) + at[i]);
        }
    }
}

NodeSums move_nodes(const NodeRows& rows) {
    const float dt = rows.time_step, c2 = dt / (1 + rows.damping * dt / 2);
    EightSums sums = {};
    for (int node = rows.begin; node < rows.end; node += 8) {
        const int count = rows.end - node < 8 ? rows.end - node : 8;
        EightNodes eight = count == 8 ? load_eight(rows, node) : load_last(rows, node);
        move_eight(eight, sums, rows, c2);
        store_24(rows.next_displacement + 3 * node, eight.displacement, 3 * count);
        store_24(rows.next_velocity + 3 * node, eight.velocity, 3 * count);
        place_eight(rows, node, count, eight);
    }
    NodeSums total = {};
    float sound = 0;
    for (int i = 0; i < 8; ++i) {
        total.internal_work += sums.internal[i];
        total.damping_work += sums.damping[i];
        total.speed_squared =
            sums.speed_squared[i] > total.speed_squared ? sums.speed_squared[i] : total.speed_squared;
        sound += sums.sound[i];
    }
    total.internal_work *= dt / 2;
    total.damping_work *= dt * rows.damping / 4;
    total.speed_squared += sound;
    return total;
}

} // namespace

} // namespace resect::RESECT_TARGET
