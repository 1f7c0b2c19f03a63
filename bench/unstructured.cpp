// SPDX-License-Identifier: Apache-2.0
#include "bench/unstructured.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "base/index.hpp"
#include "mesh/adjacency.hpp"

namespace bench {

namespace {

using namespace resect;

constexpr double edge = 0.1;          // m
constexpr double jitter = 0.15;       // of a cell
constexpr double least_volume = 0.15; // of a tet that comes into being, in means

using Generator = std::mt19937_64;

void jitter_nodes(TetMesh& mesh, double reach, Generator& generator) {
    std::uniform_real_distribution<double> drawn(-reach, reach);
    for (Vec3& node : mesh.nodes) {
        for (double& x : node) {
            const double move = drawn(generator);
            if (x > 1e-9 && x < edge - 1e-9) { x += move; }
        }
    }
}

/// The three tets around the edge between the apices of two that share a face, if all are of some volume.
std::vector<Tet> flip(const TetMesh& mesh, Index slot, Index mate, double least) {
    const Index apex = mesh.tets[row(mate / 4)][row(mate % 4)];
    std::vector<Tet> made;
    for (std::size_t k = 0; k < 4; ++k) {
        if (k == row(slot % 4)) { continue; }
        made.push_back(mesh.tets[row(slot / 4)]);
        made.back()[k] = apex;
        if (signed_volume(mesh, made.back()) < least) { return {}; }
    }
    return made;
}

/// Each tet at most once.
void flip_pairs(TetMesh& mesh, Generator& generator) {
    const std::vector<Index> mates = build_face_mates(mesh);
    std::vector<Index> slots(mates.size());
    std::iota(slots.begin(), slots.end(), 0);
    std::shuffle(slots.begin(), slots.end(), generator);
    const double least = least_volume * edge * edge * edge / static_cast<double>(mesh.tets.size());
    std::vector<std::uint8_t> used(mesh.tets.size(), 0);
    for (const Index slot : slots) {
        const Index mate = mates[row(slot)];
        if (mate == no_mate || used[row(slot / 4)] != 0 || used[row(mate / 4)] != 0) { continue; }
        const std::vector<Tet> made = flip(mesh, slot, mate, least);
        if (made.empty()) { continue; }
        used[row(slot / 4)] = used[row(mate / 4)] = 1;
        mesh.tets[row(slot / 4)] = made[0];
        mesh.tets[row(mate / 4)] = made[1];
        mesh.tets.push_back(made[2]);
    }
}

void shuffle(TetMesh& mesh, Generator& generator) {
    std::vector<Index> place(mesh.nodes.size());
    std::iota(place.begin(), place.end(), 0);
    std::shuffle(place.begin(), place.end(), generator);
    std::vector<Vec3> nodes(mesh.nodes.size());
    for (std::size_t node = 0; node < place.size(); ++node) {
        nodes[row(place[node])] = mesh.nodes[node];
    }
    mesh.nodes = std::move(nodes);
    for (Tet& tet : mesh.tets) {
        for (Index& node : tet) {
            node = place[row(node)];
        }
    }
    std::shuffle(mesh.tets.begin(), mesh.tets.end(), generator);
}

} // namespace

Body make_unstructured_cube(Index cells, std::uint64_t seed) {
    Generator generator(seed);
    Body body = must(make_block({edge, edge, edge}, {cells, cells, cells}));
    jitter_nodes(body.elements, jitter * edge / cells, generator);
    flip_pairs(body.elements, generator);
    shuffle(body.elements, generator);
    return body;
}

} // namespace bench
