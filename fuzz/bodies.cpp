// SPDX-License-Identifier: Apache-2.0
#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/lattice.hpp"
#include "mesh/liver.hpp"
#include "random.hpp"

namespace resect::fuzz {
namespace {

/// A share of a cell by which each coordinate of a node may go; those on the block's sides stay there.
Vec3 draw_move(Random& random, const BodySpec& spec, Index node) {
    Vec3 move = {};
    Index rest = node;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Index at = rest % (spec.cells[axis] + 1);
        rest /= spec.cells[axis] + 1;
        const double reach = spec.jitter * spec.size[axis] / spec.cells[axis];
        const double drawn = random.draw(-reach, reach);
        if (at > 0 && at < spec.cells[axis]) { move[axis] = drawn; }
    }
    return move;
}

void move_nodes(TetMesh& mesh, const BodySpec& spec) {
    Random random(spec.seed);
    std::vector<std::vector<Index>> tets_of(mesh.nodes.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        for (const Index node : mesh.tets[t]) {
            tets_of[row(node)].push_back(static_cast<Index>(t));
        }
    }
    const double mean = spec.size[0] * spec.size[1] * spec.size[2] / static_cast<double>(mesh.tets.size());
    for (int pass = 0; pass < spec.passes; ++pass) {
        for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
            const Vec3 before = mesh.nodes[node];
            mesh.nodes[node] += draw_move(random, spec, static_cast<Index>(node));
            const bool is_sound = std::all_of(tets_of[node].begin(), tets_of[node].end(), [&](Index t) {
                return signed_volume(mesh, mesh.tets[row(t)]) > spec.least_volume * mean;
            });
            if (!is_sound) { mesh.nodes[node] = before; }
        }
    }
}

} // namespace

BodySpec jittered_block(Index cells, std::uint64_t seed) {
    BodySpec spec;
    spec.cells = {cells, cells, cells};
    spec.jitter = 0.2;
    spec.seed = seed;
    return spec;
}

BodySpec crumpled_block(Index cells, std::uint64_t seed) {
    BodySpec spec = jittered_block(cells, seed);
    spec.jitter = 0.35;
    spec.passes = 6;
    spec.least_volume = 0.02;
    return spec;
}

Body make_body(const BodySpec& spec) {
    Body body;
    if (spec.is_liver) {
        const Fault fault =
            build_lattice_body(liver_shape, liver_bounds, {spec.spacing, spec.offset, spec.refine}, body);
        return must(fault ? Result<Body>(*fault) : Result<Body>(std::move(body)));
    }
    body = must(make_block(spec.size, spec.cells));
    if (spec.jitter > 0) { move_nodes(body.elements, spec); }
    return body;
}

double mean_edge(const Body& body) {
    double volume = 0;
    for (const Tet& tet : body.elements.tets) {
        volume += signed_volume(body.elements, tet);
    }
    return std::cbrt(6 * volume / static_cast<double>(body.elements.tets.size()));
}

} // namespace resect::fuzz
