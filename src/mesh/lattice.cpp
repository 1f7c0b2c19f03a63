// SPDX-License-Identifier: Apache-2.0
#include "mesh/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

#include "base/assert.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/edge_rows.hpp"

namespace resect {
namespace {

/// Tets whose centre is nearer to the surface than this share of their size are refined with those that meet
/// it.
constexpr double band = 0.2;
/// Outside lattice tets whose nearest corner is nearer to the surface than this, in spacings, may hold
/// material that finer tets find: a tet's circumradius is 0.56, and a shape is only about a distance.
constexpr double reach = 0.75;
/// Vertices nearer to the surface than this share of the finest spacing lie on it.
constexpr double snapped = 0.06;
constexpr std::size_t most_elements = 20'000'000;
constexpr std::size_t most_material = 200'000'000;

/// Material while it is made: tets over points with the shape's values; `element_of` names rows of `lattice`.
struct Draft {
    TetMesh material = {};
    std::vector<double> values = {};    // [vertex of material] negative inside
    std::vector<Index> element_of = {}; // [material tet]
    std::vector<Tet> lattice = {};      // [lattice tet] rows of material.nodes
};

Error too_large(const LatticePlan& plan, std::size_t tets) {
    return Error{
        fmt::format("spacing {:.4g} m at refine {} makes {} tets, too many to hold: take a larger spacing",
                    plan.spacing, plan.refine, tets)};
}

double greatest_value(const Draft& draft, const Tet& tet) {
    const auto& values = draft.values;
    return std::max({values[row(tet[0])], values[row(tet[1])], values[row(tet[2])], values[row(tet[3])]});
}

double least_value(const Draft& draft, const Tet& tet) {
    const auto& values = draft.values;
    return std::min({values[row(tet[0])], values[row(tet[1])], values[row(tet[2])], values[row(tet[3])]});
}

/// Keeps the material tets for which `keep(row, tet)` holds.
template <class Keep>
void keep_material(Draft& draft, const Keep& keep) {
    auto& tets = draft.material.tets;
    std::size_t kept = 0;
    for (std::size_t tet = 0; tet < tets.size(); ++tet) {
        if (!keep(tet, tets[tet])) { continue; }
        tets[kept] = tets[tet];
        draft.element_of[kept++] = draft.element_of[tet];
    }
    tets.resize(kept);
    draft.element_of.resize(kept);
}

/// Leaves out the tets so deep inside that they hold material and touch no tet at the surface, and counts
/// them.
Index set_aside_deep_tets(double spacing, Draft& draft) {
    const std::size_t before = draft.material.tets.size();
    keep_material(draft, [&](std::size_t, const Tet& tet) { return greatest_value(draft, tet) > -spacing; });
    return static_cast<Index>(before - draft.material.tets.size());
}

Vec3 centre_of(const TetMesh& mesh, const Tet& tet) {
    const auto& p = mesh.nodes;
    return 0.25 * (p[row(tet[0])] + p[row(tet[1])] + p[row(tet[2])] + p[row(tet[3])]);
}

/// Renumbers the rows in `tets` by first use, continuing `old_rows`; `new_rows` starts as -1 for all.
void number_by_use(std::vector<Tet>& tets, std::vector<Index>& new_rows, std::vector<Index>& old_rows) {
    for (Tet& tet : tets) {
        for (Index& node : tet) {
            Index& renamed = new_rows[row(node)];
            if (renamed < 0) {
                renamed = static_cast<Index>(old_rows.size());
                old_rows.push_back(node);
            }
            node = renamed;
        }
    }
}

/// The lattice tets that may hold material, each one material tet so far.
Fault lay_lattice(const Shape& shape, const Box& bounds, const LatticePlan& plan, Draft& draft) {
    LatticeGrid grid;
    if (Fault fault = make_lattice_grid(bounds, plan, grid)) { return fault; }
    std::vector<double> values;
    if (Fault fault = sample_shape(grid, shape, bounds, values)) { return fault; }
    draft.lattice = find_lattice_tets(grid, values, plan.refine > 0 ? reach * plan.spacing : 0);
    if (draft.lattice.size() > most_elements) { return too_large(plan, draft.lattice.size()); }
    std::vector<Index> new_rows(values.size(), -1);
    std::vector<Index> points;
    number_by_use(draft.lattice, new_rows, points);
    for (const Index point : points) {
        draft.material.nodes.push_back(grid.position(point));
        draft.values.push_back(values[row(point)]);
    }
    draft.material.tets = draft.lattice;
    draft.element_of.resize(draft.lattice.size());
    std::iota(draft.element_of.begin(), draft.element_of.end(), 0);
    return {};
}

/// Bisects tets along marked edges, the longest first and of equal ones the highest key, a choice that a
/// face's two tets make alike. `marked(a, b)`, and `middle(a, b)` that gives the vertex on a marked edge.
template <class Marked, class Middle>
class Bisector {
public:
    Bisector(Draft& draft, double spacing, const Marked& marked, const Middle& middle)
        : draft_(draft), quantum_(1e-7 * spacing * spacing), marked_(marked), middle_(middle) {}

    void bisect_all() {
        const std::vector<Tet> tets = std::exchange(draft_.material.tets, {});
        const std::vector<Index> element_of = std::exchange(draft_.element_of, {});
        draft_.material.tets.reserve(2 * tets.size());
        draft_.element_of.reserve(2 * tets.size());
        for (std::size_t tet = 0; tet < tets.size(); ++tet) {
            bisect(tets[tet], element_of[tet]);
        }
    }

private:
    using Rank = std::pair<std::int64_t, std::uint64_t>;

    Rank rank(Index a, Index b) const {
        const Vec3 along = draft_.material.nodes[row(a)] - draft_.material.nodes[row(b)];
        return {std::llround(dot(along, along) / quantum_), edge_key(a, b)};
    }

    /// The corners of the edge to bisect next, or equal ones if none is left.
    std::pair<std::size_t, std::size_t> next_edge(const Tet& tet) const {
        std::pair<std::size_t, std::size_t> best = {0, 0};
        Rank highest = {-1, 0};
        for (const auto& corners : edge_corners) {
            const std::size_t a = row(corners[0]);
            const std::size_t b = row(corners[1]);
            if (!marked_(tet[a], tet[b])) { continue; }
            const Rank found = rank(tet[a], tet[b]);
            if (found <= highest) { continue; }
            highest = found;
            best = {a, b};
        }
        return best;
    }

    void bisect(const Tet& tet, Index element) {
        const auto [a, b] = next_edge(tet);
        if (a == b) {
            draft_.material.tets.push_back(tet);
            draft_.element_of.push_back(element);
            return;
        }
        const Index vertex = middle_(tet[a], tet[b]);
        Tet half = tet;
        half[b] = vertex;
        bisect(half, element);
        half = tet;
        half[a] = vertex;
        bisect(half, element);
    }

    Draft& draft_;
    double quantum_;
    const Marked& marked_;
    const Middle& middle_;
};

Index append_vertex(Draft& draft, const Vec3& p, double value) {
    draft.material.nodes.push_back(p);
    draft.values.push_back(value);
    return static_cast<Index>(draft.values.size() - 1);
}

/// The shape's value over its slope, a distance wherever the shape is smooth; the plain value where it is
/// far.
double estimate_distance(const Shape& shape, const Vec3& p, double size) {
    const double value = shape(p);
    if (std::abs(value) > 2 * size) { return value; }
    const double h = 1e-4 * size;
    Vec3 slope = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 ahead = p;
        Vec3 behind = p;
        ahead[axis] += h;
        behind[axis] -= h;
        slope[axis] = (shape(ahead) - shape(behind)) / (2 * h);
    }
    return value / std::max(length(slope), 1e-3);
}

/// Whether a tet of this size meets the surface, or nearly.
bool is_at_surface(const Shape& shape, const Draft& draft, const Tet& tet, double size) {
    const double least = least_value(draft, tet);
    const double greatest = greatest_value(draft, tet);
    if (least < 0 && greatest >= 0) { return true; }
    if (least >= size || greatest <= -size) { return false; }
    return std::abs(estimate_distance(shape, centre_of(draft.material, tet), size)) < band * size;
}

/// Marks the edges of tets at the surface that are not yet halved.
EdgeRows mark_surface_edges(const Shape& shape, const Draft& draft, double size) {
    EdgeRows marks;
    const auto& nodes = draft.material.nodes;
    for (const Tet& tet : draft.material.tets) {
        if (!is_at_surface(shape, draft, tet, size)) { continue; }
        for (const auto& corners : edge_corners) {
            const Index a = tet[row(corners[0])];
            const Index b = tet[row(corners[1])];
            if (length(nodes[row(a)] - nodes[row(b)]) > 0.4 * size) { marks[edge_key(a, b)] = -1; }
        }
    }
    return marks;
}

/// Lays the surface through the vertices that it nearly meets: cut close to a vertex, tets would be tiny, and
/// a crossing kept away from the vertex instead would leave a pit. The vertices stay where they are, since
/// those of the lattice carry the embedding.
void snap_surface(const Shape& shape, double size, Draft& draft) {
    for (std::size_t vertex = 0; vertex < draft.values.size(); ++vertex) {
        double& value = draft.values[vertex];
        if (std::abs(value) > 4 * snapped * size) { continue; }
        if (std::abs(estimate_distance(shape, draft.material.nodes[vertex], size)) < snapped * size) {
            value = 0;
        }
    }
}

/// Halves the edges of tets that meet the surface.
void refine_once(const Shape& shape, double spacing, double size, Draft& draft) {
    EdgeRows marks = mark_surface_edges(shape, draft, size);
    const auto marked = [&](Index a, Index b) { return marks.find(edge_key(a, b)) != nullptr; };
    const auto middle = [&](Index a, Index b) {
        Index& vertex = marks[edge_key(a, b)];
        if (vertex < 0) {
            const Vec3 p = 0.5 * (draft.material.nodes[row(a)] + draft.material.nodes[row(b)]);
            vertex = append_vertex(draft, p, shape(p));
        }
        return vertex;
    };
    Bisector(draft, spacing, marked, middle).bisect_all();
}

/// Where the shape changes sign between p and p + d, as a share of d, kept away from the ends. `inside` < 0
/// <= `outside` are its values there. False position with the Illinois rule: an end that stays counts half.
double find_crossing(const Shape& shape, const Vec3& p, const Vec3& d, double inside, double outside) {
    constexpr int most_rounds = 40;
    double low = 0;
    double high = 1;
    double t = 0;
    int stayed = 0;
    for (int round = 0; round < most_rounds && high - low > 1e-10; ++round) {
        t = (low * outside - high * inside) / (outside - inside);
        const double value = shape(p + t * d);
        if (value == 0 || !std::isfinite(value)) { break; }
        if (value < 0) {
            low = t;
            inside = value;
            if (stayed == 1) { outside /= 2; }
            stayed = 1;
        } else {
            high = t;
            outside = value;
            if (stayed == -1) { inside /= 2; }
            stayed = -1;
        }
    }
    return std::clamp(t, least_crossing, 1 - least_crossing);
}

/// Bisects every edge that crosses the surface and drops the tets outside.
void cut_at_surface(const Shape& shape, double spacing, Draft& draft) {
    EdgeRows crossings;
    const auto is_in = [&](Index vertex) { return draft.values[row(vertex)] < 0; };
    const auto is_out = [&](Index vertex) { return draft.values[row(vertex)] > 0; };
    const auto marked = [&](Index a, Index b) { return (is_in(a) && is_out(b)) || (is_out(a) && is_in(b)); };
    const auto crossing = [&](Index a, Index b) {
        Index& vertex = crossings[edge_key(a, b)];
        if (vertex >= 0) { return vertex; }
        if (!is_in(a)) { std::swap(a, b); }
        const Vec3 p = draft.material.nodes[row(a)];
        const Vec3 d = draft.material.nodes[row(b)] - p;
        const double t = find_crossing(shape, p, d, draft.values[row(a)], draft.values[row(b)]);
        vertex = append_vertex(draft, p + t * d, 0);
        return vertex;
    };
    Bisector(draft, spacing, marked, crossing).bisect_all();
    keep_material(draft, [&](std::size_t, const Tet& tet) { return least_value(draft, tet) < 0; });
}

/// Drops pieces that hang together with nothing and hold less than one element; the largest piece stays.
void drop_crumbs(double spacing, Draft& draft, std::vector<std::string>& notes) {
    const Components components = build_components(build_face_mates(draft.material));
    if (components.sizes.size() == 1) { return; }
    std::vector<double> volumes(components.sizes.size(), 0);
    for (std::size_t tet = 0; tet < draft.material.tets.size(); ++tet) {
        volumes[row(components.of_tet[tet])] += signed_volume(draft.material, draft.material.tets[tet]);
    }
    const double least =
        std::min(spacing * spacing * spacing / 12, *std::max_element(volumes.begin(), volumes.end()));
    const auto crumbs = std::count_if(volumes.begin(), volumes.end(), [&](double v) { return v < least; });
    if (crumbs == 0) { return; }
    keep_material(draft,
                  [&](std::size_t tet, const Tet&) { return volumes[row(components.of_tet[tet])] >= least; });
    notes.push_back(
        fmt::format("{} loose crumbs smaller than an element ({:.3g} m^3) were dropped", crumbs, least));
}

/// The elements that hold material, and vertices that begin with their nodes.
Body compact(Draft draft, double spacing) {
    Body body;
    std::vector<Index> new_elements(draft.lattice.size(), -1);
    for (Index& element : draft.element_of) {
        Index& renamed = new_elements[row(element)];
        if (renamed < 0) {
            renamed = static_cast<Index>(body.elements.tets.size());
            body.elements.tets.push_back(draft.lattice[row(element)]);
        }
        element = renamed;
    }
    std::vector<Index> new_rows(draft.material.nodes.size(), -1);
    std::vector<Index> old_rows;
    number_by_use(body.elements.tets, new_rows, old_rows);
    const std::size_t node_count = old_rows.size();
    number_by_use(draft.material.tets, new_rows, old_rows);
    for (const Index old : old_rows) {
        body.material.nodes.push_back(draft.material.nodes[row(old)]);
    }
    body.elements.nodes.assign(body.material.nodes.begin(),
                               body.material.nodes.begin() + static_cast<std::ptrdiff_t>(node_count));
    body.material.tets = std::move(draft.material.tets);
    body.element_of = std::move(draft.element_of);
    body.lattice_spacing = spacing;
    return body;
}

/// Refuses a shape that is not finite at a vertex, or negative out of its bounds.
Fault check_vertices(const Draft& draft, const Box& bounds) {
    for (std::size_t vertex = 0; vertex < draft.values.size(); ++vertex) {
        if (Fault fault = check_value(draft.values[vertex], draft.material.nodes[vertex], bounds)) {
            return fault;
        }
    }
    return {};
}

/// Refines the material where it meets the surface.
Fault refine(const Shape& shape, const Box& bounds, const LatticePlan& plan, Draft& draft) {
    for (int level = 0; level < plan.refine; ++level) {
        refine_once(shape, plan.spacing, std::ldexp(plan.spacing, -level), draft);
        if (draft.material.tets.size() > most_material) {
            return too_large(plan, draft.material.tets.size());
        }
    }
    if (Fault fault = check_vertices(draft, bounds)) { return fault; }
    snap_surface(shape, std::ldexp(plan.spacing, -plan.refine), draft);
    return {};
}

Error empty_body(const LatticePlan& plan) {
    return Error{
        fmt::format("no material was found at spacing {:.4g} m, refine {}: the body is empty or thinner than "
                    "the lattice; check the function's sign, the bounds and the spacing",
                    plan.spacing, plan.refine)};
}

} // namespace

Fault build_lattice_body(const Shape& shape, const Box& bounds, const LatticePlan& plan, Body& body) {
    Draft draft;
    if (Fault fault = lay_lattice(shape, bounds, plan, draft)) { return fault; }
    if (Fault fault = refine(shape, bounds, plan, draft)) { return fault; }
    cut_at_surface(shape, plan.spacing, draft);
    if (draft.material.tets.empty()) { return empty_body(plan); }
    std::vector<std::string> notes;
    drop_crumbs(plan.spacing, draft, notes);
    body = compact(std::move(draft), plan.spacing);
    body.notes = std::move(notes);
    return {};
}

/// An element holds material exactly if one of its vertices lies inside.
Fault count_lattice_elements(const Shape& shape, const Box& bounds, const LatticePlan& plan, Index& count) {
    Draft draft;
    if (Fault fault = lay_lattice(shape, bounds, plan, draft)) { return fault; }
    const Index deep = set_aside_deep_tets(plan.spacing, draft);
    if (Fault fault = refine(shape, bounds, plan, draft)) { return fault; }
    std::vector<char> holds(draft.lattice.size(), 0);
    for (std::size_t tet = 0; tet < draft.material.tets.size(); ++tet) {
        if (least_value(draft, draft.material.tets[tet]) < 0) { holds[row(draft.element_of[tet])] = 1; }
    }
    count = deep + static_cast<Index>(std::count(holds.begin(), holds.end(), 1));
    return {};
}

} // namespace resect
