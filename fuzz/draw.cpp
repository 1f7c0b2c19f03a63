// SPDX-License-Identifier: Apache-2.0
#include "draw.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "arrangement.hpp"

namespace resect::fuzz {
namespace {

constexpr double pi = std::numbers::pi;

Edge around(const Vec3& centre, const Vec3& along, double reach) {
    return {centre + reach * direction(along), centre - reach * direction(along)};
}

BodySpec draw_block(Random& random, Index least, Index most) {
    // The square makes small ones common, which are cheap and have the more boundary.
    const double share = random.draw(0, 1);
    const Index cells = least + static_cast<Index>(share * share * (most - least + 1));
    const auto seed = static_cast<std::uint64_t>(random.pick(0, 1 << 30));
    return random.chance(0.6) ? jittered_block(cells, seed) : crumpled_block(cells, seed);
}

/// A vector with its axes in another order.
Vec3 reorder(const Vec3& v, const std::array<std::size_t, 3>& order) {
    return {v[order[0]], v[order[1]], v[order[2]]};
}

Plane draw_plane(Random& random, Index cells) {
    if (random.chance(0.7)) { return {random.draw_direction(), random.draw_vector(0.3, 0.7)}; }
    // Through nodes of a block that is not jittered: along its faces, or their diagonals.
    const Vec3 normals[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, -1}, {1, 1, 1}};
    const double at = static_cast<double>(random.pick(1, cells - 1)) / cells;
    return {normals[random.pick(0, 5)], {at, at, at}};
}

/// A long blade in the plane that moves along `heading`, made to lie in it.
std::vector<Edge> sweep_plane(const Plane& plane, const Vec3& heading) {
    const Vec3 normal = direction(plane.normal);
    const Vec3 forward = direction(heading - dot(heading, normal) * normal);
    const Vec3 along = cross(normal, forward);
    return {around(plane.point - 1.5 * forward, along, 5), around(plane.point + 1.5 * forward, along, 5)};
}

/// The piece that strokes aim at: points on its skin, and how large it is.
struct Target {
    std::vector<Vec3> skin = {};
    std::vector<Vec3> normal = {}; // outwards
    Vec3 centre = {};
    double size = 0; // m, half of the diagonal of its box
};

/// A held piece most often: free ones fall away.
Index pick_piece(Random& random, std::span<const Piece> pieces) {
    const bool only_held = random.chance(0.85);
    std::vector<Index> ids;
    for (const Piece& piece : pieces) {
        if (piece.held || !only_held) { ids.push_back(piece.id); }
    }
    if (ids.empty()) { return pieces.front().id; }
    return ids[row(random.pick(0, static_cast<Index>(ids.size()) - 1))];
}

Target find_target(Random& random, Simulation& simulation) {
    const Index id = pick_piece(random, simulation.pieces());
    const Surface surface = simulation.surface();
    Target target;
    Box box;
    for (std::size_t i = 0; i < surface.triangle.size(); ++i) {
        if (surface.piece[i] != id) { continue; }
        const auto& [a, b, c] = surface.triangle[i];
        const Vec3 p = to_double(surface.position[row(a)]);
        const Vec3 q = to_double(surface.position[row(b)]);
        const Vec3 r = to_double(surface.position[row(c)]);
        const Vec3 middle = (1.0 / 3) * (p + q + r);
        if (target.skin.empty()) { box = {middle, middle}; }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], middle[axis]);
            box.hi[axis] = std::max(box.hi[axis], middle[axis]);
        }
        target.skin.push_back(middle);
        target.normal.push_back(direction(cross(q - p, r - p)));
    }
    target.centre = 0.5 * (box.lo + box.hi);
    target.size = 0.5 * length(box.hi - box.lo);
    return target;
}

std::size_t pick_skin(Random& random, const Target& target) {
    return row(random.pick(0, static_cast<Index>(target.skin.size()) - 1));
}

/// A way of a blade: where a point of its edge is and where the edge points, at times from 0 to 1.
struct Way {
    std::function<Vec3(double)> point = {};
    Vec3 along = {}, turn = {};  // at the start, and what is added by the end
    double below = 0, above = 0; // m, of the blade from the point to tip and heel
};

std::vector<Edge> follow(const Way& way, int poses) {
    std::vector<Edge> followed;
    for (int i = 0; i < poses; ++i) {
        const double t = static_cast<double>(i) / (poses - 1);
        const Vec3 along = direction(way.along + t * way.turn);
        followed.push_back({way.point(t) + way.above * along, way.point(t) - way.below * along});
    }
    return followed;
}

/// A blade of some length that stands across `heading` more or less.
Way draw_way(Random& random, const Target& target, const Vec3& heading) {
    const Vec3 drawn = random.draw_direction();
    Way way;
    way.along = direction(drawn - 0.9 * dot(drawn, heading) * heading);
    way.turn = random.draw_vector(-0.4, 0.4);
    way.below = random.draw(0.2, 1.2) * target.size;
    way.above = random.draw(0.2, 1.2) * target.size;
    return way;
}

/// From one point of the skin to another, from outside or inside to outside or inside, straight or not.
Way draw_chord(Random& random, const Target& target, bool is_curved) {
    const Vec3 from = target.skin[pick_skin(random, target)];
    const Vec3 aim = target.skin[pick_skin(random, target)];
    const Vec3 to = length(aim - from) > 0.3 * target.size ? aim : 2.0 * target.centre - from;
    const Vec3 heading = direction(to - from);
    const double begin = random.chance(0.2) ? 0.2 : -0.3;
    const double end = random.chance(0.3) ? random.draw(0.4, 0.8) : 1.3;
    const Vec3 bow = (is_curved ? random.draw(-0.4, 0.4) * target.size : 0.0) * random.draw_direction();
    Way way = draw_way(random, target, heading);
    way.point = [=](double t) {
        return from + (begin + t * (end - begin)) * (to - from) + std::sin(pi * t) * bow;
    };
    return way;
}

/// A figure of eight, or a loop, around the blade.
Way draw_loop(Random& random, const Target& target) {
    const Vec3 heading = random.draw_direction();
    Way way = draw_way(random, target, heading);
    const Vec3 across = direction(cross(way.along, random.draw_direction()));
    const Vec3 other = cross(way.along, across);
    const double reach = random.draw(0.2, 0.5) * target.size;
    const double turns = random.draw(0.8, 1.6);
    const bool is_eight = random.chance(0.5);
    const Vec3 centre = target.centre + 0.2 * target.size * random.draw_direction();
    way.turn = 0.2 * way.turn;
    way.point = [=](double t) {
        const double a = 2 * pi * turns * t;
        return centre + reach * (std::cos(a) * across + std::sin(is_eight ? 2 * a : a) * other);
    };
    return way;
}

/// In along a chord, out again, and in once more nearly there.
Way draw_return(Random& random, const Target& target) {
    Way way = draw_chord(random, target, false);
    const std::function<Vec3(double)> chord = way.point;
    const Vec3 miss = random.draw(0, 0.02) * target.size * random.draw_direction();
    way.turn = {};
    way.point = [=](double t) {
        if (t < 0.4) { return chord(1.75 * t); }
        if (t < 0.7) { return chord(0.7 - 2 * (t - 0.4)); }
        return chord(0.1 + 3 * (t - 0.7)) + miss;
    };
    return way;
}

/// The tip a little below the skin.
Way draw_shallow(Random& random, const Target& target) {
    const std::size_t at = pick_skin(random, target);
    const Vec3 start = target.skin[at];
    const Vec3 normal = target.normal[at];
    const Vec3 drawn = random.draw_direction();
    const Vec3 heading = direction(drawn - dot(drawn, normal) * normal);
    const double run = random.draw(0.3, 0.8) * target.size;
    Way way;
    way.along = normal;
    way.turn = random.draw_vector(-0.2, 0.2);
    way.below = random.draw(0.02, 0.3) * target.size;
    way.above = target.size;
    way.point = [=](double t) { return start + (t - 0.3) * run * heading; };
    return way;
}

/// Through a node of the elements as they lie now, along an edge of theirs or in a face.
Stroke draw_on_mesh(Random& random, const Simulation& simulation, double size) {
    const Nodes nodes = simulation.nodes();
    const Copies copies = simulation.copies();
    const auto& corners = copies.node[row(random.pick(0, static_cast<Index>(copies.node.size()) - 1))];
    const auto place = [&](std::size_t corner) {
        const std::size_t node = row(corners[corner]);
        return to_double(nodes.rest[node]) + to_double(nodes.displacement[node]);
    };
    const Index of = random.pick(0, 2); // node, edge, face
    const Vec3 edge = direction(place(1) - place(0));
    const Vec3 along = of == 0 ? random.draw_direction() : edge;
    const Vec3 drawn = of < 2 ? random.draw_direction() : direction(place(2) - place(0));
    const Vec3 heading = direction(drawn - dot(drawn, along) * along);
    const double reach = random.draw(0.4, 2) * size;
    const double run = random.draw(0.4, 2) * size;
    Stroke stroke;
    stroke.is_still = true;
    stroke.blades = {
        {around(place(0) - run * heading, along, reach), around(place(0) + run * heading, along, reach)}};
    return stroke;
}

Way draw_any_way(Random& random, const Target& target) {
    const double kind = random.draw(0, 1);
    if (kind < 0.35) { return draw_chord(random, target, false); }
    if (kind < 0.6) { return draw_chord(random, target, true); }
    if (kind < 0.75) { return draw_loop(random, target); }
    if (kind < 0.88) { return draw_return(random, target); }
    return draw_shallow(random, target);
}

} // namespace

Case draw_sweep(std::uint64_t seed) {
    Random random(seed);
    Case drawn;
    drawn.what = "a curved sweep of a long turning blade through waving tissue";
    drawn.seed = seed;
    drawn.body = draw_block(random, 3, 8);
    drawn.waves = {random.draw(0.02, 0.10), random.draw(2, 9), random.draw(0, 6)};
    const double a0 = random.draw(-0.5, 0.5);
    const double a1 = random.draw(-0.5, 0.5);
    const double b0 = random.draw(-0.4, 0.4);
    const double b1 = random.draw(-0.4, 0.4);
    const double h0 = random.draw(0.4, 0.6);
    const double h1 = random.draw(0.4, 0.6);
    const double bow = random.draw(-0.1, 0.1);
    std::array<std::size_t, 3> order = {0, 1, 2};
    std::rotate(order.begin(), order.begin() + random.pick(0, 2), order.end());
    if (random.chance(0.5)) { std::swap(order[0], order[1]); }
    const Index increments = 8 + 40 * random.pick(0, 5);
    std::vector<Edge> poses;
    for (Index i = 0; i <= increments; ++i) {
        const double t = static_cast<double>(i) / increments;
        const double a = a0 + (a1 - a0) * t;
        const double b = b0 + (b1 - b0) * t;
        const Vec3 centre = {-1 + 3 * t, 0.5, h0 + (h1 - h0) * t + bow * std::sin(pi * t)};
        const Vec3 along = {std::sin(a), std::cos(a) * std::cos(b), std::sin(b)};
        poses.push_back(around(reorder(centre, order), reorder(along, order), 5));
    }
    drawn.strokes = {{.blades = {std::move(poses)}}};
    drawn.expected = {.pieces = 2, .is_on_sheet = increments > 8};
    return drawn;
}

Case draw_planes(std::uint64_t seed) {
    Random random(seed);
    Case drawn;
    drawn.what = "planes through a block";
    drawn.seed = seed;
    drawn.body = draw_block(random, 3, 8);
    if (random.chance(0.2)) { drawn.body.jitter = 0; }
    const Index cells = drawn.body.cells[0];
    const Index count = random.pick(1, 6);
    const double least = 0.5 / (6.0 * cells * cells * cells);
    std::vector<Plane> planes;
    std::vector<double> volumes;
    do {
        planes.clear();
        for (Index i = 0; i < count; ++i) {
            planes.push_back(draw_plane(random, cells));
        }
        volumes = compute_cells({{0, 0, 0}, {1, 1, 1}}, planes);
    } while (volumes.front() < least);
    const Index at_once = random.chance(0.7) ? 1 : random.pick(2, 3);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        if (i % row(at_once) == 0) { drawn.strokes.push_back({.increments = 40}); }
        drawn.strokes.back().blades.push_back(sweep_plane(planes[i], random.draw_direction()));
    }
    drawn.expected = {
        .pieces = static_cast<Index>(volumes.size()), .is_unpinched = count == 1, .is_on_sheet = true};
    return drawn;
}

Case draw_moving_body(std::uint64_t seed) {
    Random random(seed);
    Case drawn;
    drawn.what = "strokes through a body under gravity";
    drawn.seed = seed;
    drawn.is_simulated = true;
    const Index kind = random.pick(0, 2);
    if (kind == 0) {
        drawn.body.is_liver = true;
        drawn.body.spacing = random.draw(0.022, 0.032);
        drawn.body.offset = random.draw_vector(0, 1);
        drawn.body.refine = random.pick(0, 1);
    } else {
        const auto shape_seed = static_cast<std::uint64_t>(random.pick(0, 1 << 30));
        drawn.body = kind == 1 ? jittered_block(3, shape_seed) : crumpled_block(3, shape_seed);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            drawn.body.cells[axis] = random.pick(3, random.chance(0.2) ? 8 : 5);
            drawn.body.size[axis] = 0.02 * drawn.body.cells[axis];
        }
    }
    // Load numbers rho g L / E up to 0.05: what is softer is a matter of the solver (docs/method.md).
    drawn.forces.young = (drawn.body.is_liver ? 5e4 : 2e4) * random.draw(1, 4);
    drawn.forces.damping = random.chance(0.5) ? 0 : random.draw(0, 4);
    drawn.forces.gravity = random.chance(0.5) ? Vec3{0, 0, -9.81} : 9.81 * random.draw_direction();
    drawn.forces.kick = random.chance(0.5) ? 0 : random.draw(0, 0.3);
    return drawn;
}

Stroke draw_stroke(Random& random, Simulation& simulation) {
    const Target target = find_target(random, simulation);
    if (random.chance(0.15)) { return draw_on_mesh(random, simulation, target.size); }
    const int poses = random.pick(5, 30);
    const int blades = random.chance(0.15) ? random.pick(2, 3) : 1;
    Stroke stroke;
    stroke.seconds = random.draw(0.05, 0.2);
    for (int b = 0; b < blades; ++b) {
        stroke.blades.push_back(follow(draw_any_way(random, target), poses));
    }
    return stroke;
}

} // namespace resect::fuzz
