// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "cut/homes.hpp"
#include "cut/partition.hpp"
#include "cut/pieces.hpp"
#include "cut/weigh.hpp"

// The checks of docs/cutting.md: each says what is broken, or nothing.
namespace resect {
namespace {

bool has_vertex(const MaterialTet& tet, Index vertex) { return corner_of(tet.vertex, vertex) < 4; }

std::string check_link(const Cutter& cutter, Index t, std::size_t k) {
    const MaterialMesh& material = cutter.material;
    const MaterialTet& tet = material.tet(t);
    const Index link = tet.link[k];
    if (tet_of(link) >= material.tet_count()) { return fmt::format("tet {} is linked to no tet", t); }
    const MaterialTet& other = material.tet(tet_of(link));
    if (other.link[face_of(link)] != make_link(t, k)) {
        return fmt::format("tet {} is linked one way only", t);
    }
    for (std::size_t j = 0; j < 4; ++j) {
        if (j != k && !has_vertex(other, tet.vertex[j])) {
            return fmt::format("tets {} and {} are linked but share no face", t, tet_of(link));
        }
    }
    if (has_vertex(other, tet.vertex[k])) { return fmt::format("tet {} overlaps tet {}", t, tet_of(link)); }
    const bool leaves_element =
        cutter.mesh.copy_element[row(tet.copy)] != cutter.mesh.copy_element[row(other.copy)];
    if (leaves_element != (tet.element_face[k] >= 0)) {
        return fmt::format("the face between tets {} and {} does not lie on an element's face", t,
                           tet_of(link));
    }
    if (!leaves_element && tet.copy != other.copy) {
        return fmt::format("tets {} and {} are linked inside an element but lie in two copies", t,
                           tet_of(link));
    }
    return {};
}

std::string check_element_face(const Cutter& cutter, Index t, std::size_t k) {
    const MaterialTet& tet = cutter.material.tet(t);
    if (tet.element_face[k] < 0) { return {}; }
    const Index opposite = cutter.element(tet.copy)[std::size_t(tet.element_face[k])];
    for (std::size_t j = 0; j < 4; ++j) {
        if (j != k && weight_of(cutter.material.support[row(tet.vertex[j])], opposite) != 0) {
            return fmt::format("face {} of tet {} lies off the element's face", k, t);
        }
    }
    return {};
}

std::string check_conformity(const Cutter& cutter) {
    for (Index t = 0; t < cutter.material.tet_count(); ++t) {
        const MaterialTet& tet = cutter.material.tet(t);
        for (const Index v : tet.vertex) {
            for (const Index node : cutter.material.support[row(v)].node) {
                if (node >= 0 && corner_of(cutter.element(tet.copy), node) == 4) {
                    return fmt::format("vertex {} of tet {} needs a node outside its element", v, t);
                }
            }
        }
        for (std::size_t k = 0; k < 4; ++k) {
            if (std::string broken = check_element_face(cutter, t, k); !broken.empty()) { return broken; }
            if (tet.link[k] < 0) { continue; }
            if (std::string broken = check_link(cutter, t, k); !broken.empty()) { return broken; }
        }
    }
    return {};
}

std::string check_volumes(const Cutter& cutter) {
    const MaterialMesh& material = cutter.material;
    double sum = 0;
    for (Index t = 0; t < material.tet_count(); ++t) {
        const MaterialTet& tet = material.tet(t);
        const double volume =
            signed_volume(material.at(tet, 0), material.at(tet, 1), material.at(tet, 2), material.at(tet, 3));
        const double element = cutter.element_volume[row(cutter.mesh.copy_element[row(tet.copy)])];
        if (!(volume > 0)) { return fmt::format("tet {} has the volume {:.3g}", t, volume); }
        if (std::abs(volume - tet.volume) > 1e-6 * tet.volume + 1e-11 * element) {
            return fmt::format("tet {} is noted with the volume {:.9g} and has {:.9g}", t, tet.volume,
                               volume);
        }
        sum += tet.volume;
    }
    if (std::abs(sum - cutter.initial_volume) > 1e-12 * cutter.initial_volume) {
        return fmt::format("the material's volume went from {:.15g} to {:.15g}", cutter.initial_volume, sum);
    }
    return {};
}

std::string check_stars(const Cutter& cutter) {
    const MaterialMesh& material = cutter.material;
    std::vector<std::size_t> tets(material.rest.size(), 0);
    for (const MaterialTet& tet : material.tets) {
        for (const Index v : tet.vertex) {
            ++tets[row(v)];
        }
    }
    Marks walked;
    std::vector<Index> star;
    for (Index v = 0; v < material.vertex_count(); ++v) {
        if (tets[row(v)] == 0) { continue; }
        if (!has_vertex(material.tet(material.any_tet[row(v)]), v)) {
            return fmt::format("vertex {} is not of the tet noted for it", v);
        }
        walked.clear(material.tets.size());
        star.clear();
        walk_star(material, v, material.any_tet[row(v)], walked, star);
        if (star.size() != tets[row(v)]) {
            return fmt::format("the star of vertex {} fell apart: {} of {} tets", v, star.size(),
                               tets[row(v)]);
        }
    }
    return {};
}

std::string check_copies(const Cutter& cutter) {
    const SimulationMesh& mesh = cutter.mesh;
    std::size_t listed = 0;
    std::vector<double> share(cutter.element_volume.size(), 0);
    std::vector<double> weight(cutter.element_volume.size(), 0);
    std::vector<Index> count(cutter.element_volume.size(), 0);
    for (std::size_t c = 0; c < mesh.copy_node.size(); ++c) {
        const std::size_t element = row(mesh.copy_element[c]);
        double volume = 0;
        for (Index m = cutter.first_tet[c]; m >= 0; m = cutter.material.tet(m).next) {
            ++listed;
            volume += cutter.material.tet(m).volume;
            if (cutter.material.tet(m).copy != Index(c)) { return fmt::format("tet {} is in two copies", m); }
        }
        if (std::abs(volume / cutter.element_volume[element] - mesh.copy_fraction[c]) > 1e-12) {
            return fmt::format("copy {} is noted with the fraction {:.9g}", c, mesh.copy_fraction[c]);
        }
        share[element] += mesh.copy_fraction[c];
        weight[element] += mesh.copy_weight[c];
        ++count[element];
    }
    if (listed != cutter.material.tets.size()) { return "a tet is in no copy"; }
    const bool whole = cutter.setup.options.weights == Weights::copy;
    for (std::size_t e = 0; e < share.size(); ++e) {
        const double fill = cutter.element_fill[e];
        if (std::abs(share[e] - fill) > 1e-12) {
            return fmt::format("the copies of element {} do not fill it", e);
        }
        if (std::abs(weight[e] - cutter.element_weight[e] * (whole ? count[e] : 1)) > 1e-12) {
            return fmt::format("the weights of element {} sum to {:.9g}", e, weight[e]);
        }
    }
    for (std::size_t c = 0; c < mesh.copy_node.size(); ++c) {
        const std::size_t e = row(mesh.copy_element[c]);
        const double floor = weight_floor(count[e]);
        if (!(mesh.copy_weight[c] >= (1 - 1e-12) * floor * cutter.element_weight[e])) {
            return fmt::format("copy {} weighs {:.3g}, less than its floor", c, mesh.copy_weight[c]);
        }
    }
    return {};
}

/// The nodes are the classes of a partition made from scratch, with their sums.
std::string check_nodes(const Cutter& cutter) {
    const SimulationMesh& mesh = cutter.mesh;
    const std::vector<Index> label = label_pairs(cutter);
    std::vector<Index> node_of(label.size(), -1);
    std::vector<Index> label_of(mesh.node_reference.size(), -1);
    std::vector<double> mass(mesh.node_reference.size(), 0);
    for (Index pair = 0; row(pair) < label.size(); ++pair) {
        const Index copy = pair / 4;
        const Index node = mesh.copy_node[row(copy)][face_of(pair)];
        const Index root = label[row(pair)];
        if (mesh.node_reference[row(node)] != cutter.element(copy)[face_of(pair)]) {
            return fmt::format("node {} stands for two element nodes", node);
        }
        if (node_of[row(root)] < 0) { node_of[row(root)] = node; }
        if (label_of[row(node)] < 0) { label_of[row(node)] = root; }
        if (node_of[row(root)] != node || label_of[row(node)] != root) {
            return fmt::format("node {} is not one class of copies", node);
        }
        const std::size_t element = row(mesh.copy_element[row(copy)]);
        mass[row(node)] += mesh.copy_weight[row(copy)] * cutter.setup.element_mass[element] / 4;
    }
    for (std::size_t n = 0; n < mass.size(); ++n) {
        if (label_of[n] < 0) { return fmt::format("node {} belongs to no copy", n); }
        if (!(std::abs(mass[n] - mesh.node_mass[n]) <= 1e-12 * mass[n])) {
            return fmt::format("node {} is noted with {:.9g} kg and has {:.9g}", n, mesh.node_mass[n],
                               mass[n]);
        }
    }
    return {};
}

/// Scattered displacements, the same for one node and axis every time.
std::vector<Vec3> scatter_nodes(const Cutter& cutter) {
    std::vector<Vec3> displacement(cutter.mesh.node_reference.size());
    std::uint32_t seed = 12345;
    for (Vec3& u : displacement) {
        for (double& x : u) {
            seed = 1664525U * seed + 1013904223U;
            x = cutter.unit * (seed / 4294967296.0 - 0.5);
        }
    }
    return displacement;
}

/// Copies that links join, one after the other, are of one piece, and no others are.
std::string check_pieces(const Cutter& cutter) {
    const MaterialMesh& material = cutter.material;
    std::vector<std::uint8_t> met(material.tets.size(), 0);
    std::vector<std::uint8_t> known(cutter.pieces.pieces.size(), 0);
    std::vector<Index> stack;
    for (Index seed = 0; seed < material.tet_count(); ++seed) {
        if (met[row(seed)] != 0) { continue; }
        const Index piece = cutter.pieces.of_copy[row(material.tet(seed).copy)];
        if (known[row(piece)] != 0) { return fmt::format("piece {} has fallen apart", piece); }
        known[row(piece)] = 1;
        met[row(seed)] = 1;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const MaterialTet& tet = material.tet(stack.back());
            stack.pop_back();
            if (cutter.pieces.of_copy[row(tet.copy)] != piece) {
                return fmt::format("copy {} is noted for another piece than {}", tet.copy, piece);
            }
            for (const Index link : tet.link) {
                if (link < 0 || met[row(tet_of(link))] != 0) { continue; }
                met[row(tet_of(link))] = 1;
                stack.push_back(tet_of(link));
            }
        }
    }
    return {};
}

std::string check_embedding(const Cutter& cutter) {
    const MaterialMesh& material = cutter.material;
    const std::vector<Vec3> displacement = scatter_nodes(cutter);
    std::vector<Vec3> place(material.rest.size());
    std::vector<std::uint8_t> known(material.rest.size(), 0);
    for (const MaterialTet& tet : material.tets) {
        for (const Index v : tet.vertex) {
            const Support& support = material.support[row(v)];
            const std::array<Index, 4> node = find_nodes(cutter, support, tet.copy);
            Vec3 p = {};
            for (std::size_t i = 0; i < 4; ++i) {
                if (node[i] >= 0) { p += support.weight[i] * displacement[row(node[i])]; }
            }
            if (known[row(v)] != 0 && length(p - place[row(v)]) > 1e-12 * cutter.unit) {
                return fmt::format("vertex {} is torn apart by its copies", v);
            }
            place[row(v)] = p;
            known[row(v)] = 1;
        }
    }
    return {};
}

std::string check_boundary(const Cutter& cutter) {
    const MaterialMesh& material = cutter.material;
    struct Side {
        Index low, high, turn;
        bool operator<(const Side& other) const {
            return std::tie(low, high, turn) < std::tie(other.low, other.high, other.turn);
        }
    };
    std::vector<Side> sides;
    double volume = 0;
    for (const MaterialTet& tet : material.tets) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] >= 0) {
                if (tet.label[k] != 0) { return "a linked face is labelled as a side of a sheet"; }
                continue;
            }
            const auto& [a, b, c] = face_corners[k];
            volume +=
                dot(material.at(tet, row(a)), cross(material.at(tet, row(b)), material.at(tet, row(c)))) / 6;
            for (std::size_t i = 0; i < 3; ++i) {
                const Index from = tet.vertex[row(face_corners[k][i])];
                const Index to = tet.vertex[row(face_corners[k][(i + 1) % 3])];
                sides.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
            }
        }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size();) {
        Index turns = 0;
        const Side first = sides[i];
        for (; i < sides.size() && sides[i].low == first.low && sides[i].high == first.high; ++i) {
            turns += sides[i].turn;
        }
        if (turns != 0) { return fmt::format("the surface is open at edge ({}, {})", first.low, first.high); }
    }
    if (std::abs(volume - cutter.initial_volume) > 1e-10 * cutter.initial_volume) {
        return fmt::format("the surface encloses {:.12g} of {:.12g} m^3", volume, cutter.initial_volume);
    }
    return {};
}

} // namespace

std::string find_broken_invariant(const Cutter& cutter) {
    for (const auto check : {check_conformity, check_volumes, check_stars, check_copies, check_nodes,
                             check_pieces, check_embedding, check_boundary}) {
        std::string broken = check(cutter);
        if (!broken.empty()) { return broken; }
    }
    return {};
}

} // namespace resect
