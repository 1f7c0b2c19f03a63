// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <random>
#include <vector>

#include "cut/cutter_state.hpp"

namespace resect {

/// A block of n^3 cells of six tets (Kuhn) with edges of 1 m, inner nodes moved by up to `jitter` cells.
inline Body make_cube(int n, double jitter, unsigned seed) {
    Body body;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-jitter / n, jitter / n);
    const auto id = [n](const std::array<int, 3>& c) { return (c[0] * (n + 1) + c[1]) * (n + 1) + c[2]; };
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            for (int k = 0; k <= n; ++k) {
                Vec3 p = {double(i) / n, double(j) / n, double(k) / n};
                for (double& x : p) {
                    if (x > 0 && x < 1) { x += shift(random); }
                }
                body.elements.nodes.push_back(p);
            }
        }
    }
    constexpr unsigned paths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int cell = 0; cell < n * n * n; ++cell) {
        for (const auto& path : paths) {
            std::array<int, 3> c = {cell / (n * n), cell / n % n, cell % n};
            Tet tet = {id(c), 0, 0, 0};
            for (unsigned s = 0; s < 3; ++s) {
                ++c[path[s]];
                tet[s + 1] = id(c);
            }
            if (signed_volume(body.elements, tet) < 0) { std::swap(tet[2], tet[3]); }
            body.elements.tets.push_back(tet);
        }
    }
    return body;
}

/// One kilogram a cubic metre.
inline CutterSetup make_setup(const Body& body) {
    CutterSetup setup;
    for (const Tet& tet : body.elements.tets) {
        setup.element_mass.push_back(signed_volume(body.elements, tet));
    }
    return setup;
}

inline CutterPtr cutter_of(const Body& body, Weights weights = Weights::fraction) {
    CutterSetup setup = make_setup(body);
    setup.options.weights = weights;
    return must(make_cutter(body, std::move(setup)));
}

using Motion3 = std::function<Vec3(Vec3, double)>; // place at a time
using Poses = std::function<Edge(double)>;         // of a blade, at a time

inline Vec3 stay(Vec3 p, double) { return p; }

inline std::vector<Vec3f> displacements(const Cutter& cutter, const Motion3& motion, double time) {
    std::vector<Vec3f> u;
    for (const Index reference : cutter.mesh.node_reference) {
        const Vec3& rest = cutter.body.elements.nodes[row(reference)];
        u.push_back(to_float(motion(rest, time) - rest));
    }
    return u;
}

/// Sweeps a blade from time 0 to 1 while all nodes follow `motion`.
inline CutReport sweep(Cutter& cutter, const Poses& poses, int increments, const Motion3& motion = stay,
                       Index blade = 0) {
    CutReport report;
    Delta delta;
    for (int i = 0; i < increments; ++i) {
        const double to = double(i + 1) / increments;
        sweep_blade(cutter, blade, poses(to), displacements(cutter, motion, double(i) / increments),
                    displacements(cutter, motion, to), delta, report);
    }
    return report;
}

/// The same as a whole stroke.
inline CutReport stroke(Cutter& cutter, const Poses& poses, int increments, const Motion3& motion = stay) {
    place_blade(cutter, 0, poses(0));
    CutReport report = sweep(cutter, poses, increments, motion);
    lift_blade(cutter, 0);
    return report;
}

/// A long blade in the plane through p across n, which moves along `heading` made to lie in the plane.
inline Poses plane_poses(const Vec3& n, const Vec3& p, const Vec3& heading) {
    const Vec3 normal = direction(n);
    const Vec3 forward = direction(heading - dot(heading, normal) * normal);
    const Vec3 along = cross(normal, forward);
    return [=](double t) {
        const Vec3 centre = p + (-1.5 + 3 * t) * forward;
        return Edge{centre + 5.0 * along, centre - 5.0 * along};
    };
}

inline double draw(std::mt19937& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

inline Vec3 draw_vector(std::mt19937& random, double low, double high) {
    const double x = draw(random, low, high);
    const double y = draw(random, low, high);
    return {x, y, draw(random, low, high)};
}

/// Tissue that waves while it is cut.
inline Motion3 draw_waves(std::mt19937& random, double least, double most) {
    const double size = draw(random, least, most);
    const double pace = draw(random, 2, 9);
    const double phase = draw(random, 0, 6);
    return [=](Vec3 p, double t) {
        return p + size * Vec3{std::sin(3 * p[1] + pace * t + phase), std::sin(4 * p[2] + pace * t),
                               std::cos(3 * p[0] - pace * t + phase)};
    };
}

inline Edge around(const Vec3& centre, const Vec3& along, double reach) {
    return {centre + reach * direction(along), centre - reach * direction(along)};
}

/// A blade of finite length that turns while it crosses the unit cube, or a part of it.
inline Poses draw_stroke(std::mt19937& random) {
    const Vec3 from = draw_vector(random, -0.3, 1.3);
    const Vec3 to = draw_vector(random, -0.3, 1.3);
    const Vec3 along = direction(draw_vector(random, -1, 1));
    const Vec3 turn = draw_vector(random, -0.4, 0.4);
    const double reach = draw(random, 0.05, 0.75);
    return [=](double t) { return around(from + t * (to - from), along + t * turn, reach); };
}

inline std::vector<Piece> pieces_of(Cutter& cutter) {
    const std::vector<Vec3f> rest(cutter.mesh.node_reference.size());
    const auto pieces = update_pieces(cutter, rest, cutter.mesh.node_held);
    return {pieces.begin(), pieces.end()};
}

inline double mass_of(const Cutter& cutter) {
    double mass = 0;
    for (const double m : cutter.mesh.node_mass) {
        mass += m;
    }
    return mass;
}

} // namespace resect
