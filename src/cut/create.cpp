// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <tuple>
#include <utility>

#include "cut/beside.hpp"
#include "cut/homes.hpp"
#include "cut/partition.hpp"
#include "cut/pieces.hpp"
#include "cut/stages.hpp"
#include "cut/transaction.hpp"
#include "cut/weigh.hpp"

namespace resect {
namespace {

// Barycentric coordinates this close to zero are zero: coordinates come from files and from bisections in
// floating point. Two elements see a shared vertex alike within ten times that.
constexpr double support_tolerance = 1e-9;
constexpr double agreement_tolerance = 1e-8;
/// Material tets of an element from which it is cut along their faces only: cuts that cross it without end
/// would else fill memory and time.
constexpr Index crowd_unrefined = 200;
constexpr std::size_t reserved = 4; // times the rows at creation

using Problem = std::string; // empty: none

Problem check_mesh(const TetMesh& mesh, const char* name) {
    for (std::size_t v = 0; v < mesh.nodes.size(); ++v) {
        if (!is_finite(mesh.nodes[v])) {
            return fmt::format("{} vertex {} is not finite: mend its coordinates", name, v);
        }
    }
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        for (const Index v : mesh.tets[t]) {
            if (v < 0 || row(v) >= mesh.nodes.size()) {
                return fmt::format("{} tet {} names vertex {}, which does not exist: mend the mesh", name, t,
                                   v);
            }
        }
        if (!(signed_volume(mesh, mesh.tets[t]) > 0)) {
            return fmt::format("{} tet {} is flat or inverted: remove it or swap two of its vertices", name,
                               t);
        }
    }
    return {};
}

Problem check_input(const Body& body, const CutterSetup& setup) {
    const std::size_t elements = body.elements.tets.size();
    if (elements == 0) { return "the body has no elements: give it some"; }
    if (setup.element_mass.size() != elements) {
        return fmt::format("{} masses for {} elements: give one each", setup.element_mass.size(), elements);
    }
    for (const HeldRegion& region : setup.held) {
        if (!region.node_marked.empty() && region.node_marked.size() != body.elements.nodes.size()) {
            return fmt::format("a held region marks {} of {} nodes: give one mark each",
                               region.node_marked.size(), body.elements.nodes.size());
        }
    }
    if (Problem problem = check_mesh(body.elements, "element"); !problem.empty()) { return problem; }
    if (body.element_of.size() != body.material.tets.size()) {
        return fmt::format("{} material tets name {} elements: give one each", body.material.tets.size(),
                           body.element_of.size());
    }
    for (std::size_t t = 0; t < body.element_of.size(); ++t) {
        if (body.element_of[t] < 0 || row(body.element_of[t]) >= elements) {
            return fmt::format("material tet {} lies in element {}, which does not exist: mend element_of", t,
                               body.element_of[t]);
        }
    }
    for (std::size_t v = 0; v < std::min(body.material.nodes.size(), body.elements.nodes.size()); ++v) {
        if (!body.material.tets.empty() && body.material.nodes[v] != body.elements.nodes[v]) {
            return fmt::format(
                "material vertex {} lies apart from element node {}: let the element nodes come first", v, v);
        }
    }
    return check_mesh(body.material, "material");
}

/// Material that fills the elements, where the body names none.
void fill_elements(Body& body) {
    if (!body.material.tets.empty()) { return; }
    body.material = body.elements;
    body.element_of.resize(body.elements.tets.size());
    std::iota(body.element_of.begin(), body.element_of.end(), 0);
}

void measure_elements(Cutter& cutter) {
    const TetMesh& elements = cutter.body.elements;
    for (const Tet& tet : elements.tets) {
        cutter.element_volume.push_back(signed_volume(elements, tet));
    }
    cutter.mean_volume = std::accumulate(cutter.element_volume.begin(), cutter.element_volume.end(), 0.0) /
                         static_cast<double>(cutter.element_volume.size());
    const Box box = bounds_of(elements);
    cutter.unit = length(box.hi - box.lo);
}

/// Tets with the element as copy for now: the rows of copies follow.
void fill_material(Cutter& cutter) {
    const Body& body = cutter.body;
    MaterialMesh& material = cutter.material;
    for (const Vec3& vertex : body.material.nodes) {
        material.rest.push_back(vertex);
    }
    material.support.grow(material.rest.size(), {});
    material.any_tet.grow(material.rest.size(), -1);
    material.on_cut.grow(material.rest.size(), 0);
    for (std::size_t t = 0; t < body.material.tets.size(); ++t) {
        MaterialTet tet;
        tet.vertex = body.material.tets[t];
        tet.copy = body.element_of[t];
        tet.volume = signed_volume(body.material, tet.vertex);
        cutter.initial_volume += tet.volume;
        for (const Index v : tet.vertex) {
            material.any_tet.edit(row(v)) = static_cast<Index>(t);
        }
        material.tets.push_back(tet);
    }
}

/// The edge of the cube of which six such tets make one, of the largest tet of an element; vertices take the
/// mean of the tets around them.
void measure_grain(Cutter& cutter) {
    MaterialMesh& material = cutter.material;
    std::vector<double> largest(cutter.element_volume.size(), 0);
    for (const MaterialTet& tet : material.tets) {
        largest[row(tet.copy)] = std::max(largest[row(tet.copy)], tet.volume);
    }
    material.grain.grow(material.rest.size(), 0);
    std::vector<double> tets(material.rest.size(), 0);
    for (const MaterialTet& tet : material.tets) {
        const double grain = std::cbrt(6 * largest[row(tet.copy)]);
        cutter.grain = std::max(cutter.grain, grain);
        for (const Index v : tet.vertex) {
            material.grain.edit(row(v)) += grain;
            tets[row(v)] += 1;
        }
    }
    for (std::size_t v = 0; v < tets.size(); ++v) {
        material.grain.edit(v) /= std::max(1.0, tets[v]);
    }
}

Problem link_faces(MaterialMesh& material) {
    struct Face {
        std::array<Index, 3> vertex;
        Index link;
        bool operator<(const Face& other) const {
            return vertex != other.vertex ? vertex < other.vertex : link < other.link;
        }
    };
    std::vector<Face> faces;
    faces.reserve(4 * material.tets.size());
    for (Index t = 0; t < material.tet_count(); ++t) {
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& [a, b, c] = face_corners[k];
            const Tet& v = material.tet(t).vertex;
            Face face = {{v[row(a)], v[row(b)], v[row(c)]}, make_link(t, k)};
            std::sort(face.vertex.begin(), face.vertex.end());
            faces.push_back(face);
        }
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 1; i < faces.size(); ++i) {
        if (faces[i].vertex != faces[i - 1].vertex) { continue; }
        const Index a = faces[i - 1].link;
        const Index b = faces[i].link;
        if (material.tet(tet_of(a)).link[face_of(a)] >= 0) {
            return fmt::format("material tet {} is the third at one face: let no more than two share a face",
                               tet_of(b));
        }
        material.edit_tet(tet_of(a)).link[face_of(a)] = b;
        material.edit_tet(tet_of(b)).link[face_of(b)] = a;
    }
    return {};
}

Support support_in(const Body& body, Index vertex, Index element) {
    const Tet& corners = body.elements.tets[row(element)];
    if (row(vertex) < body.elements.nodes.size()) {
        return corner_of(corners, vertex) < 4 ? Support{{vertex, -1, -1, -1}, {1, 0, 0, 0}} : Support{};
    }
    std::array<Vec3, 4> p = {};
    for (std::size_t k = 0; k < 4; ++k) {
        p[k] = body.elements.nodes[row(corners[k])];
    }
    return find_support(corners, p, body.material.nodes[row(vertex)], support_tolerance);
}

Problem find_supports(Cutter& cutter) {
    MaterialMesh& material = cutter.material;
    for (Index t = 0; t < material.tet_count(); ++t) {
        const Index element = material.tet(t).copy;
        for (const Index v : material.tet(t).vertex) {
            const Support found = support_in(cutter.body, v, element);
            if (found.node[0] < 0) {
                return fmt::format(
                    "material vertex {} lies outside element {}, which its tet {} is said to lie in: "
                    "mend element_of or the vertex",
                    v, element, t);
            }
            Support& known = material.support.edit(row(v));
            if (known.node[0] < 0) { known = found; }
            if (!is_same(known, found, agreement_tolerance)) {
                return fmt::format(
                    "material vertex {} lies on a face of some of its elements and inside element {}: "
                    "let it lie on a face, edge or node of all of them",
                    v, element);
            }
        }
    }
    return {};
}

/// The element's face that holds a face of a tet: none of the three vertices needs the opposite corner.
std::int8_t find_element_face(const MaterialMesh& material, const MaterialTet& tet, std::size_t k,
                              const Tet& element) {
    for (std::size_t face = 0; face < 4; ++face) {
        double weight = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            if (j != k) { weight += weight_of(material.support[row(tet.vertex[j])], element[face]); }
        }
        if (weight == 0) { return static_cast<std::int8_t>(face); }
    }
    return -1;
}

Problem find_element_faces(Cutter& cutter) {
    MaterialMesh& material = cutter.material;
    for (Index t = 0; t < material.tet_count(); ++t) {
        MaterialTet& tet = material.edit_tet(t);
        for (std::size_t k = 0; k < 4; ++k) {
            tet.element_face[k] =
                find_element_face(material, tet, k, cutter.body.elements.tets[row(tet.copy)]);
            const bool leaves = tet.link[k] >= 0 && material.tet(tet_of(tet.link[k])).copy != tet.copy;
            if (leaves && tet.element_face[k] < 0) {
                return fmt::format(
                    "material tets {} and {} share a face inside an element but name two elements: "
                    "mend element_of",
                    t, tet_of(tet.link[k]));
            }
        }
    }
    return {};
}

/// A vertex at which material only touches becomes one for each part of its star.
void part_pinched_vertices(MaterialMesh& material) {
    std::vector<std::vector<Index>> tets_of(material.rest.size());
    for (Index t = 0; t < material.tet_count(); ++t) {
        for (const Index v : material.tet(t).vertex) {
            tets_of[row(v)].push_back(t);
        }
    }
    Marks walked;
    std::vector<Index> star;
    for (std::size_t v = 0; v < tets_of.size(); ++v) {
        walked.clear(material.tets.size());
        for (const Index seed : tets_of[v]) {
            if (walked.has(seed)) { continue; }
            star.clear();
            walk_star(material, static_cast<Index>(v), seed, walked, star);
            if (seed == tets_of[v].front()) {
                material.any_tet.edit(v) = seed;
            } else {
                split_vertex(material, static_cast<Index>(v), star);
            }
        }
    }
}

/// [tet] The lowest tet of the same element that links inside the element join it to.
std::vector<Index> label_parts(const MaterialMesh& material) {
    std::vector<Index> part(material.tets.size(), -1);
    std::vector<Index> stack;
    for (Index seed = 0; seed < material.tet_count(); ++seed) {
        if (part[row(seed)] >= 0) { continue; }
        part[row(seed)] = seed;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const MaterialTet& tet = material.tet(stack.back());
            stack.pop_back();
            for (const Index link : tet.link) {
                if (link < 0 || part[row(tet_of(link))] >= 0) { continue; }
                if (material.tet(tet_of(link)).copy != tet.copy) { continue; }
                part[row(tet_of(link))] = seed;
                stack.push_back(tet_of(link));
            }
        }
    }
    return part;
}

/// Copy e is the largest part of element e; further parts follow, by element.
Problem make_copies(Cutter& cutter) {
    MaterialMesh& material = cutter.material;
    const auto elements = static_cast<Index>(cutter.element_volume.size());
    const std::vector<Index> part = label_parts(material);
    std::vector<double> volume(material.tets.size(), 0); // [part]
    for (std::size_t t = 0; t < part.size(); ++t) {
        volume[row(part[t])] += material.tets[t].volume;
    }

    std::vector<Index> largest(row(elements), -1); // [element] part
    for (std::size_t t = 0; t < part.size(); ++t) {
        Index& best = largest[row(material.tets[t].copy)];
        if (part[t] == Index(t) && (best < 0 || volume[t] > volume[row(best)])) { best = part[t]; }
    }
    for (Index e = 0; e < elements; ++e) {
        if (largest[row(e)] < 0) { return fmt::format("element {} holds no material: remove it", e); }
    }
    std::vector<std::pair<Index, Index>> others; // element, part
    for (std::size_t t = 0; t < part.size(); ++t) {
        const Index element = material.tets[t].copy;
        if (part[t] == Index(t) && part[t] != largest[row(element)]) {
            others.emplace_back(element, part[t]);
        }
    }
    std::sort(others.begin(), others.end());

    SimulationMesh& mesh = cutter.mesh;
    std::vector<Index> copy_of(material.tets.size(), -1); // [part]
    for (Index e = 0; e < elements; ++e) {
        copy_of[row(largest[row(e)])] = e;
        mesh.copy_element.push_back(e);
        cutter.first_copy.push_back(e);
        cutter.sibling.push_back(-1);
    }
    for (const auto& [element, other] : others) {
        const auto copy = static_cast<Index>(mesh.copy_element.size());
        copy_of[row(other)] = copy;
        mesh.copy_element.push_back(element);
        cutter.sibling.push_back(std::exchange(cutter.sibling.edit(row(element)), copy));
    }
    mesh.copy_fraction.grow(mesh.copy_element.size(), 0);
    mesh.copy_weight.grow(mesh.copy_element.size(), 0);
    cutter.first_tet.grow(mesh.copy_element.size(), -1);
    cutter.tet_count.grow(row(elements), 0);
    for (Index t = material.tet_count() - 1; t >= 0; --t) {
        MaterialTet& tet = material.edit_tet(t);
        tet.copy = copy_of[row(part[row(t)])];
        tet.next = std::exchange(cutter.first_tet.edit(row(tet.copy)), t);
        ++cutter.tet_count.edit(row(mesh.copy_element[row(tet.copy)]));
    }
    return {};
}

/// The solver's share of each element: that of its material, but no less than a floor, whose mass the others
/// give in proportion to what they have above it; so the body weighs what its material does.
void share_weight(Cutter& cutter) {
    double lacking = 0; // kg
    double spare = 0;   // kg
    for (std::size_t e = 0; e < cutter.element_fill.size(); ++e) {
        const double above = cutter.element_fill[e] - least_element_weight;
        (above < 0 ? lacking : spare) += std::abs(above) * cutter.setup.element_mass[e];
    }
    // A body of next to nothing but nearly empty elements has no mass to spare.
    const bool shared = lacking > 0 && lacking < spare;
    for (const double fill : cutter.element_fill) {
        const double above = std::max(0.0, fill - least_element_weight);
        cutter.element_weight.push_back(shared ? least_element_weight + above * (1 - lacking / spare) : fill);
    }
}

Problem weigh_copies(Cutter& cutter) {
    SimulationMesh& mesh = cutter.mesh;
    cutter.element_fill.assign(cutter.element_volume.size(), 0);
    for (std::size_t c = 0; c < mesh.copy_element.size(); ++c) {
        const std::size_t element = row(mesh.copy_element[c]);
        double volume = 0;
        for (Index m = cutter.first_tet[c]; m >= 0; m = cutter.material.tet(m).next) {
            volume += cutter.material.tet(m).volume;
        }
        mesh.copy_fraction.edit(c) = volume / cutter.element_volume[element];
        cutter.element_fill[element] += mesh.copy_fraction[c];
    }
    for (std::size_t e = 0; e < cutter.element_fill.size(); ++e) {
        if (cutter.element_fill[e] > 1 + support_tolerance) {
            return fmt::format("element {} holds {:.6g} times its volume: let material tets not overlap", e,
                               cutter.element_fill[e]);
        }
    }
    share_weight(cutter);
    for (std::size_t e = 0; e < cutter.element_fill.size(); ++e) {
        weigh_element(cutter, static_cast<Index>(e));
    }
    return {};
}

/// [element node] Where in the order it stands.
std::vector<Index> rank_nodes(const Cutter& cutter) {
    std::vector<Index> rank(cutter.body.elements.nodes.size());
    std::iota(rank.begin(), rank.end(), 0);
    for (std::size_t i = 0; i < cutter.setup.node_order.size(); ++i) {
        rank[row(cutter.setup.node_order[i])] = static_cast<Index>(i);
    }
    return rank;
}

/// Nodes are the classes of pairs, by rank of their reference node and then by lowest pair; so they are the
/// element nodes where each of these has one class.
void make_nodes(Cutter& cutter) {
    SimulationMesh& mesh = cutter.mesh;
    const std::vector<Index> label = label_pairs(cutter);
    const std::vector<Index> rank = rank_nodes(cutter);
    struct Pair {
        Index rank, label, pair;
        bool operator<(const Pair& other) const {
            return std::tie(rank, label, pair) < std::tie(other.rank, other.label, other.pair);
        }
    };
    const auto reference_of = [&](Index pair) { return cutter.element(pair / 4)[face_of(pair)]; };
    std::vector<Pair> pairs;
    pairs.reserve(label.size());
    for (Index pair = 0; row(pair) < label.size(); ++pair) {
        pairs.push_back({rank[row(reference_of(pair))], label[row(pair)], pair});
    }
    std::sort(pairs.begin(), pairs.end());
    mesh.copy_node.grow(mesh.copy_element.size(), {});
    std::vector<Index> members;
    for (std::size_t begin = 0; begin < pairs.size();) {
        const auto node = static_cast<Index>(mesh.node_reference.size());
        members.clear();
        std::size_t end = begin;
        for (; end < pairs.size() && pairs[end].label == pairs[begin].label; ++end) {
            members.push_back(pairs[end].pair);
            mesh.copy_node.edit(row(pairs[end].pair / 4))[face_of(pairs[end].pair)] = node;
        }
        mesh.node_reference.push_back(reference_of(pairs[begin].pair));
        mesh.node_mass.push_back(sum_mass(cutter, members));
        mesh.node_home.push_back({});
        mesh.node_held.push_back(0);
        update_home(cutter, node, members);
        begin = end;
    }
}

/// Room for what cuts add, in state and scratch.
void reserve_rows(Cutter& cutter) {
    each_rows(cutter, [](auto& rows) { rows.reserve(reserved); });
    Scratch& scratch = cutter.scratch;
    const std::size_t tets = reserved * cutter.material.tets.size();
    const std::size_t vertices = reserved * cutter.material.rest.size();
    const std::size_t copies = reserved * cutter.mesh.copy_node.size();
    const std::size_t nodes = reserved * cutter.mesh.node_mass.size();
    for (Marks* marks : {&scratch.queued, &scratch.walked, &scratch.in_cluster}) {
        marks->grow(tets);
    }
    for (Marks* marks : {&scratch.relisted, &scratch.noted, &scratch.reached}) {
        marks->grow(copies);
    }
    scratch.walked_pairs.grow(4 * copies);
    scratch.reweighed.grow(nodes);
    scratch.tracked.grow(vertices);
    scratch.classified.grow(nodes);
    scratch.node_outside.resize(nodes);
    scratch.tracks.resize(vertices);
    scratch.flood_of.resize(copies);
    scratch.next_flooded.resize(copies);
}

Problem build_cutter(Cutter& cutter) {
    if (Problem problem = check_input(cutter.body, cutter.setup); !problem.empty()) { return problem; }
    fill_elements(cutter.body);
    measure_elements(cutter);
    fill_material(cutter);
    measure_grain(cutter);
    if (Problem problem = link_faces(cutter.material); !problem.empty()) { return problem; }
    if (Problem problem = find_supports(cutter); !problem.empty()) { return problem; }
    if (Problem problem = find_element_faces(cutter); !problem.empty()) { return problem; }
    part_pinched_vertices(cutter.material);
    if (Problem problem = make_copies(cutter); !problem.empty()) { return problem; }
    if (Problem problem = weigh_copies(cutter); !problem.empty()) { return problem; }
    for (std::size_t copy = 0; copy < cutter.mesh.copy_element.size(); ++copy) {
        cutter.beside.push_back(find_beside(cutter, static_cast<Index>(copy)));
    }
    mark_held_faces(cutter);
    make_nodes(cutter);
    mark_held_elements(cutter);
    cutter.pieces.of_copy.grow(cutter.mesh.copy_node.size(), -1);
    label_pieces(cutter);
    cutter.crowd = crowd_unrefined << cutter.setup.options.refine;
    index_by_place(cutter);
    reserve_rows(cutter);
    cutter.body.material = {};
    cutter.body.element_of = {};
    return {};
}

} // namespace

void CutterDeleter::operator()(Cutter* cutter) const { delete cutter; }

Result<CutterPtr> make_cutter(const Body& body, CutterSetup setup) {
    CutterPtr cutter(new Cutter);
    cutter->body = body;
    cutter->setup = std::move(setup);
    if (Problem problem = build_cutter(*cutter); !problem.empty()) { return Error{std::move(problem)}; }
    return cutter;
}

const SimulationMesh& simulation_mesh(const Cutter& cutter) { return cutter.mesh; }

Body material_body(const Cutter& cutter) {
    Body body = cutter.body;
    body.material.nodes.assign(cutter.material.rest.begin(), cutter.material.rest.end());
    for (const MaterialTet& tet : cutter.material.tets) {
        body.material.tets.push_back(tet.vertex);
        body.element_of.push_back(cutter.mesh.copy_element[row(tet.copy)]);
    }
    return body;
}

} // namespace resect
