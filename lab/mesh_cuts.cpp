// SPDX-License-Identifier: Apache-2.0
#include "lab/mesh_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "base/index.hpp"
#include "mesh/adjacency.hpp"

namespace lab {

using namespace resect;

namespace {

using std::numbers::pi;

constexpr double least_volume_left = 0.1; // of a tet whose node is snapped

const Vec3& corner(const TetMesh& mesh, const Tet& tet, int k) { return mesh.nodes[row(tet[row(k)])]; }

Vec3 centroid(const TetMesh& mesh, Index tet) {
    Vec3 sum = {};
    for (int k = 0; k < 4; ++k) {
        sum += corner(mesh, mesh.tets[row(tet)], k);
    }
    return 0.25 * sum;
}

/// Every corner of every tet its own node, but for those that a face that still holds joins.
class Corners {
public:
    explicit Corners(std::size_t tets) : parent_(4 * tets) { std::iota(parent_.begin(), parent_.end(), 0); }

    std::size_t find(std::size_t corner) {
        while (parent_[corner] != corner) {
            corner = parent_[corner] = parent_[parent_[corner]];
        }
        return corner;
    }
    void join(std::size_t a, std::size_t b) {
        const auto [low, high] = std::minmax({find(a), find(b)});
        parent_[high] = low;
    }

private:
    std::vector<std::size_t> parent_ = {};
};

void join_across(Corners& corners, const TetMesh& mesh, Index slot, Index mate) {
    for (const Index node : face_nodes(mesh, slot)) {
        const auto at = [&](Index tet) {
            const Tet& nodes = mesh.tets[row(tet)];
            return 4 * row(tet) +
                   row(static_cast<Index>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin()));
        };
        corners.join(at(slot / 4), at(mate / 4));
    }
}

} // namespace

std::vector<Index> find_crossed(const TetMesh& mesh, const Sheet& sheet) {
    std::vector<Index> crossed;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const Tet& tet = mesh.tets[t];
        const bool is_crossed =
            std::any_of(std::begin(edge_corners), std::end(edge_corners), [&](const auto& edge) {
                return sheet.crosses(corner(mesh, tet, edge[0]), corner(mesh, tet, edge[1]));
            });
        if (is_crossed) { crossed.push_back(static_cast<Index>(t)); }
    }
    return crossed;
}

CutMesh drop_unused_nodes(const TetMesh& mesh) {
    CutMesh kept;
    std::vector<Index> row_of(mesh.nodes.size(), -1);
    for (const Tet& tet : mesh.tets) {
        for (const Index node : tet) {
            row_of[row(node)] = 0;
        }
    }
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
        if (row_of[n] < 0) { continue; }
        row_of[n] = static_cast<Index>(kept.mesh.nodes.size());
        kept.mesh.nodes.push_back(mesh.nodes[n]);
        kept.node_from.push_back(static_cast<Index>(n));
    }
    for (Tet tet : mesh.tets) {
        for (Index& node : tet) {
            node = row_of[row(node)];
        }
        kept.mesh.tets.push_back(tet);
    }
    return kept;
}

CutMesh remove_elements(const TetMesh& mesh, const Sheet& sheet) {
    const std::vector<Index> crossed = find_crossed(mesh, sheet);
    TetMesh left{mesh.nodes, {}};
    auto next = crossed.begin();
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (next != crossed.end() && row(*next) == t) {
            ++next;
        } else {
            left.tets.push_back(mesh.tets[t]);
        }
    }
    return drop_unused_nodes(left);
}

CutMesh split_faces(const TetMesh& mesh, const Sheet& sheet) {
    const std::vector<Index> mates = build_face_mates(mesh);
    Corners corners(mesh.tets.size());
    for (std::size_t slot = 0; slot < mates.size(); ++slot) {
        const auto at = static_cast<Index>(slot);
        const Index mate = mates[slot];
        if (mate == no_mate || mate < at) { continue; }
        if (!sheet.crosses(centroid(mesh, at / 4), centroid(mesh, mate / 4))) {
            join_across(corners, mesh, at, mate);
        }
    }
    CutMesh split;
    std::map<std::size_t, Index> row_of; // by the first corner
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        Tet tet = mesh.tets[t];
        for (std::size_t k = 0; k < 4; ++k) {
            const auto [found, is_new] =
                row_of.emplace(corners.find(4 * t + k), static_cast<Index>(split.node_from.size()));
            if (is_new) {
                split.node_from.push_back(tet[k]);
                split.mesh.nodes.push_back(mesh.nodes[row(tet[k])]);
            }
            tet[k] = found->second;
        }
        split.mesh.tets.push_back(tet);
    }
    return split;
}

TetMesh snap_nodes(TetMesh mesh, const Sheet& sheet, double reach, const Box& block) {
    std::vector<std::vector<Index>> around(mesh.nodes.size());
    std::vector<double> least(mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        least[t] = least_volume_left * signed_volume(mesh, mesh.tets[t]);
        for (const Index node : mesh.tets[t]) {
            around[row(node)].push_back(static_cast<Index>(t));
        }
    }
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
        const Vec3 from = mesh.nodes[n];
        Vec3 to = sheet.nearest(from);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool is_on_face = from[axis] == block.lo[axis] || from[axis] == block.hi[axis];
            if (is_on_face) { to[axis] = from[axis]; }
        }
        if (length(to - from) > reach) { continue; }
        mesh.nodes[n] = to;
        const bool is_sound = std::all_of(around[n].begin(), around[n].end(), [&](Index tet) {
            return signed_volume(mesh, mesh.tets[row(tet)]) >= least[row(tet)];
        });
        if (!is_sound) { mesh.nodes[n] = from; }
    }
    return mesh;
}

TetMesh make_jittered_block(const Vec3& size, const std::array<Index, 3>& cells, double share,
                            unsigned seed) {
    TetMesh mesh = must(make_block(size, cells)).elements;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> drawn(-share, share);
    const double bend = share > 0 ? 0.5 * size[0] / cells[0] : 0;
    for (Vec3& node : mesh.nodes) {
        const Vec3 at = {node[0] / size[0], node[1] / size[1], node[2] / size[2]};
        node[0] += bend * std::sin(pi * at[0]) * std::sin(2 * pi * (at[1] + at[2]));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double move = drawn(random) * size[axis] / cells[axis];
            if (at[axis] > 1e-9 && at[axis] < 1 - 1e-9) { node[axis] += move; }
        }
    }
    return mesh;
}

double volume_of(const TetMesh& mesh) {
    double sum = 0;
    for (const Tet& tet : mesh.tets) {
        sum += signed_volume(mesh, tet);
    }
    return sum;
}

} // namespace lab
