// SPDX-License-Identifier: Apache-2.0
#include "oracles.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace resect::fuzz {
namespace {

std::vector<Index> count_copies(const Cutter& cutter) {
    std::vector<Index> count(cutter.element_volume.size(), 0);
    for (std::size_t c = 0; c < cutter.mesh.copy_element.size(); ++c) {
        ++count[row(cutter.mesh.copy_element[c])];
    }
    return count;
}

/// Calls visit(tet, face) for every face of the boundary.
template <class Visit>
void for_each_boundary_face(const Cutter& cutter, const Visit& visit) {
    for (Index t = 0; t < cutter.material.tet_count(); ++t) {
        const MaterialTet& tet = cutter.material.tet(t);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] < 0) { visit(tet, k); }
        }
    }
}

bool is_held_at(const HeldRegion& region, const Cutter& cutter, Index vertex) {
    if (region.node_marked.empty()) { return is_inside(region.box, cutter.material.rest[row(vertex)]); }
    const Support& support = cutter.material.support[row(vertex)];
    return std::all_of(support.node.begin(), support.node.end(),
                       [&](Index node) { return node < 0 || region.node_marked[row(node)] != 0; });
}

bool has_held_node(const Cutter& cutter, Index copy) {
    const Tet& nodes = cutter.mesh.copy_node[row(copy)];
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](Index node) { return cutter.mesh.node_held[row(node)] != 0; });
}

/// A point of a tet that stays with it: the centroid of one of its faces, over element nodes.
struct MaterialPoint {
    Vec3 rest = {};
    std::array<Index, 4> node = {}; // the element's
    std::array<double, 4> weight = {};
};

MaterialPoint centroid_of(const Cutter& cutter, const MaterialTet& tet, std::size_t face) {
    MaterialPoint point;
    point.node = cutter.element(tet.copy);
    for (std::size_t k = 0; k < 4; ++k) {
        if (k == face) { continue; }
        point.rest += (1.0 / 3) * cutter.material.at(tet, k);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            point.weight[corner] +=
                weight_of(cutter.material.support[row(tet.vertex[k])], point.node[corner]) / 3;
        }
    }
    return point;
}

/// In the blade's frame.
Vec3 place_of(const MaterialPoint& point, const Instant& instant) {
    Vec3 place = point.rest;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        place += point.weight[corner] * instant.displacement[row(point.node[corner])];
    }
    return to_frame(instant.frame, place);
}

/// The stretch of a covector n that is pulled back by the deformation of the point's element: |F^T n|.
double pull_back(const Cutter& cutter, const MaterialPoint& point, const Instant& instant, const Vec3& n) {
    std::array<Vec3, 4> p = {};
    for (std::size_t k = 0; k < 4; ++k) {
        p[k] = cutter.body.elements.nodes[row(point.node[k])];
    }
    const double six_volumes = 6 * signed_volume(p[0], p[1], p[2], p[3]);
    Vec3 pulled = n;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto& [a, b, c] = face_corners[k];
        const Vec3 gradient = (-1 / six_volumes) * cross(p[row(b)] - p[row(a)], p[row(c)] - p[row(a)]);
        pulled += dot(n, instant.displacement[row(point.node[k])]) * gradient;
    }
    return length(pulled);
}

/// Distance at rest: the least at which the blade passes the point, pulled back.
double distance_from_way(const Cutter& cutter, const MaterialPoint& point, std::span<const Instant> way) {
    double nearest = std::numeric_limits<double>::infinity();
    double at_rest = nearest;
    Vec3 before = place_of(point, way.front());
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Vec3 after = place_of(point, way[i]);
        const Vec3 run = after - before;
        const double run_squared = run[0] * run[0] + run[1] * run[1];
        const double s = run_squared > 0
                             ? std::clamp(-(before[0] * run[0] + before[1] * run[1]) / run_squared, 0.0, 1.0)
                             : 0.0;
        const Vec3 passing = before + s * run;
        const double distance = std::hypot(passing[0], passing[1]);
        before = after;
        if (distance >= nearest) { continue; }
        nearest = distance;
        const BladeFrame& frame = way[i].frame;
        const Vec3 off = direction(passing[0] * frame.across1 + passing[1] * frame.across2);
        at_rest = distance == 0 ? 0 : distance / pull_back(cutter, point, way[i], off);
    }
    return at_rest;
}

double distance_from_sheet(const Cutter& cutter, const MaterialPoint& point, Index stroke,
                           std::span<const Way> ways) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Way& way : ways) {
        if (way.stroke != stroke) { continue; }
        nearest = std::min(nearest, distance_from_way(cutter, point, way.instants));
    }
    return nearest;
}

} // namespace

double find_mass_error(const Cutter& cutter, double mass) {
    double of_nodes = 0;
    for (std::size_t n = 0; n < cutter.mesh.node_mass.size(); ++n) {
        of_nodes += cutter.mesh.node_mass[n];
    }
    double of_copies = 0;
    for (std::size_t c = 0; c < cutter.mesh.copy_weight.size(); ++c) {
        of_copies += cutter.mesh.copy_weight[c] * cutter.setup.element_mass[row(cutter.mesh.copy_element[c])];
    }
    const double by_nodes = of_nodes / mass - 1;
    const double by_copies = of_copies / mass - 1;
    return std::abs(by_nodes) > std::abs(by_copies) ? by_nodes : by_copies;
}

double find_least_weight(const Cutter& cutter) {
    const std::vector<Index> count = count_copies(cutter);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < cutter.mesh.copy_weight.size(); ++c) {
        const std::size_t element = row(cutter.mesh.copy_element[c]);
        const double floor = count[element] > 1 ? std::min(0.2, 0.5 / count[element]) : 1;
        least = std::min(least, cutter.mesh.copy_weight[c] / (floor * cutter.element_weight[element]));
    }
    return least;
}

Index count_pinched_edges(const Cutter& cutter) {
    std::vector<std::pair<Index, Index>> sides;
    for_each_boundary_face(cutter, [&](const MaterialTet& tet, std::size_t k) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = tet.vertex[row(face_corners[k][i])];
            const Index b = tet.vertex[row(face_corners[k][(i + 1) % 3])];
            sides.emplace_back(std::min(a, b), std::max(a, b));
        }
    });
    std::sort(sides.begin(), sides.end());
    Index pinched = 0;
    for (std::size_t i = 2; i < sides.size(); ++i) {
        const bool is_third = sides[i] == sides[i - 1] && sides[i] == sides[i - 2];
        if (is_third && (i == 2 || sides[i - 3] != sides[i])) { ++pinched; }
    }
    return pinched;
}

Index count_torn_faces(const Cutter& cutter) {
    Index sides = 0;
    for_each_boundary_face(cutter, [&](const MaterialTet& tet, std::size_t k) {
        if (tet.label[k] > 0) { ++sides; }
    });
    return sides;
}

Index find_most_copies(const Cutter& cutter) {
    const std::vector<Index> count = count_copies(cutter);
    return *std::max_element(count.begin(), count.end());
}

std::vector<std::uint8_t> find_held_elements(const Cutter& cutter) {
    std::vector<std::uint8_t> held(cutter.element_volume.size(), 0);
    for (std::size_t c = 0; c < cutter.mesh.copy_node.size(); ++c) {
        if (has_held_node(cutter, static_cast<Index>(c))) { held[row(cutter.mesh.copy_element[c])] = 1; }
    }
    return held;
}

Index find_lost_constraint(const Cutter& cutter, std::span<const std::uint8_t> held_before) {
    Index lost = -1;
    for_each_boundary_face(cutter, [&](const MaterialTet& tet, std::size_t k) {
        if (tet.label[k] != 0 || held_before[row(cutter.mesh.copy_element[row(tet.copy)])] == 0) { return; }
        for (const HeldRegion& region : cutter.setup.held) {
            bool is_inside_region = true;
            for (std::size_t j = 0; j < 4; ++j) {
                if (j != k) {
                    is_inside_region = is_inside_region && is_held_at(region, cutter, tet.vertex[j]);
                }
            }
            if (is_inside_region && !has_held_node(cutter, tet.copy)) { lost = tet.copy; }
        }
    });
    return lost;
}

SheetDistance measure_sheet(const Cutter& cutter, std::span<const Way> ways) {
    double sum = 0;
    SheetDistance measured;
    for_each_boundary_face(cutter, [&](const MaterialTet& tet, std::size_t k) {
        if (tet.label[k] <= 0) { return; }
        const MaterialPoint centroid = centroid_of(cutter, tet, k);
        const double distance = distance_from_sheet(cutter, centroid, tet.label[k], ways);
        sum += distance * distance;
        measured.largest = std::max(measured.largest, distance);
        ++measured.faces;
    });
    measured.root_mean_square = measured.faces > 0 ? std::sqrt(sum / measured.faces) : 0;
    return measured;
}

std::string find_stale_array(const Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    if (row(engine.elements.count) != mesh.copy_node.size()) { return "the solver lacks copies"; }
    if (engine.nodes.mass.size() != mesh.node_mass.size()) { return "the solver lacks nodes"; }
    for (Index c = 0; c < engine.elements.count; ++c) {
        if (corners(engine.elements, c) != mesh.copy_node[row(c)]) {
            return fmt::format("copy {} hangs on other nodes in the solver", c);
        }
        const double volume = engine.model.rest[row(mesh.copy_element[row(c)])].volume;
        const float weighed = engine.elements.blocks[row(c / lanes)].volume[c % lanes];
        if (weighed != static_cast<float>(mesh.copy_weight[row(c)] * volume)) {
            return fmt::format("copy {} has another weight in the solver", c);
        }
    }
    for (std::size_t n = 0; n < mesh.node_mass.size(); ++n) {
        if (engine.nodes.mass[n] != static_cast<float>(mesh.node_mass[n])) {
            return fmt::format("node {} has another mass in the solver", n);
        }
        if ((engine.nodes.inverse_mass[n] == 0) != (mesh.node_held[n] != 0)) {
            return fmt::format("node {} is held in one of S and the solver only", n);
        }
    }
    return find_packing_fault(engine.packing, engine.elements);
}

double measure_rest_bound(const Engine& engine) {
    NodeArrays at_rest;
    at_rest.displacement.resize(engine.nodes.displacement.size());
    return check_strain(engine.elements, at_rest, engine.copy_density, {0, engine.elements.count}).live_bound;
}

bool is_state_finite(const Engine& engine) {
    const auto all_finite = [](const std::vector<Vec3f>& values) {
        return std::all_of(values.begin(), values.end(), [](const Vec3f& v) { return is_finite(v); });
    };
    return all_finite(engine.nodes.displacement) && all_finite(engine.nodes.velocity);
}

} // namespace resect::fuzz
