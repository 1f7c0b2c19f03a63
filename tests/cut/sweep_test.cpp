// SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include "strokes.hpp"

namespace resect {
namespace {

TEST_CASE("a curved sweep of a turning blade through waving tissue leaves two pieces") {
    std::mt19937 random(1234);
    for (int trial = 0; trial < 60; ++trial) {
        const int n = 4 + trial % 3;
        const CutterPtr cutter = cutter_of(make_cube(n, 0.2, unsigned(trial)));
        const Motion3 waves = draw_waves(random, 0.02, 0.10);
        const double a0 = draw(random, -0.5, 0.5);
        const double a1 = draw(random, -0.5, 0.5);
        const double b0 = draw(random, -0.4, 0.4);
        const double b1 = draw(random, -0.4, 0.4);
        const double h0 = draw(random, 0.4, 0.6);
        const double h1 = draw(random, 0.4, 0.6);
        const Poses poses = [=](double t) {
            const double a = a0 + (a1 - a0) * t;
            const double b = b0 + (b1 - b0) * t;
            return around({-1 + 3 * t, 0.5, h0 + (h1 - h0) * t},
                          {std::sin(a), std::cos(a) * std::cos(b), std::sin(b)}, 5);
        };
        stroke(*cutter, poses, 8 + trial % 7 * 40, waves);
        CAPTURE(trial);
        CHECK(find_broken_invariant(*cutter) == "");
        CHECK(pieces_of(*cutter).size() == 2);
    }
}

struct Planes {
    std::vector<Vec3> normal, point;
    std::size_t cells = 0; // of the unit cube
    double smallest = 1;   // volume of the smallest
};

/// Counts the cells of the unit cube by their sign vectors at random points.
void count_cells(Planes& planes, std::mt19937& random) {
    constexpr int samples = 50000;
    std::vector<int> hits(std::size_t{1} << planes.normal.size(), 0);
    for (int s = 0; s < samples; ++s) {
        const Vec3 p = draw_vector(random, 0, 1);
        std::size_t signs = 0;
        for (std::size_t i = 0; i < planes.normal.size(); ++i) {
            signs |= std::size_t{dot(p - planes.point[i], planes.normal[i]) > 0} << i;
        }
        ++hits[signs];
    }
    for (const int count : hits) {
        if (count == 0) { continue; }
        ++planes.cells;
        planes.smallest = std::min(planes.smallest, double(count) / samples);
    }
}

Planes draw_planes(std::mt19937& random, int count, double least_volume) {
    for (;;) {
        Planes planes;
        for (int i = 0; i < count; ++i) {
            planes.normal.push_back(direction(draw_vector(random, -1, 1)));
            planes.point.push_back(draw_vector(random, 0.3, 0.7));
        }
        count_cells(planes, random);
        if (planes.smallest >= least_volume) { return planes; }
    }
}

TEST_CASE("planes cut a block into as many pieces as they have sign vectors") {
    std::mt19937 random(99);
    for (int trial = 0; trial < 40; ++trial) {
        const int n = 3 + trial % 4;
        const Planes planes = draw_planes(random, 1 + trial % 5, 0.5 / (6 * n * n * n));
        const CutterPtr cutter = cutter_of(make_cube(n, 0.2, unsigned(trial)));
        for (std::size_t i = 0; i < planes.normal.size(); ++i) {
            stroke(*cutter, plane_poses(planes.normal[i], planes.point[i], draw_vector(random, -1, 1)), 40);
        }
        CAPTURE(trial);
        CHECK(find_broken_invariant(*cutter) == "");
        CHECK(pieces_of(*cutter).size() == planes.cells);
    }
}

TEST_CASE("a hundred random strokes through waving tissue break no invariant") {
    std::mt19937 random(7);
    for (int body = 0; body < 10; ++body) {
        const CutterPtr cutter = cutter_of(make_cube(3 + body % 3, 0.2, unsigned(body)));
        const Motion3 waves = draw_waves(random, 0, 0.08);
        for (int s = 0; s < 10; ++s) {
            stroke(*cutter, draw_stroke(random), 15, waves);
            CAPTURE(body);
            CAPTURE(s);
            REQUIRE(find_broken_invariant(*cutter) == "");
        }
        double least = 1;
        for (const double weight : cutter->mesh.copy_weight) {
            least = std::min(least, weight);
        }
        CHECK(least > 0);
    }
}

TEST_CASE("a half cut leaves one piece with an open sheet") {
    const CutterPtr cutter = cutter_of(make_cube(6, 0.2, 3));
    const CutReport report = stroke(
        *cutter,
        [](double t) {
            return Edge{{0.53, -0.2 + 0.7 * t, 2}, {0.53, -0.2 + 0.7 * t, -1}};
        },
        40);
    CHECK(find_broken_invariant(*cutter) == "");
    CHECK(pieces_of(*cutter).size() == 1);
    CHECK(report.area > 0.35);
    CHECK(report.area < 0.6);
    CHECK(report.copies_added > 0);
    CHECK(report.elements_cut == report.copies_added);
}

TEST_CASE("the same stroke in 10 and in 100 increments gives the same pieces") {
    std::vector<std::vector<Piece>> pieces;
    for (const int increments : {10, 100}) {
        const CutterPtr cutter = cutter_of(make_cube(5, 0.2, 4));
        stroke(*cutter, plane_poses({0.2, 1, 0.3}, {0.5, 0.45, 0.5}, {1, 0, 0}), increments);
        stroke(*cutter, plane_poses({1, 0.1, 0.3}, {0.45, 0.5, 0.5}, {0, 0, 1}), increments);
        pieces.push_back(pieces_of(*cutter));
    }
    REQUIRE(pieces[0].size() == 4);
    REQUIRE(pieces[1].size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(pieces[0][i].id == pieces[1][i].id);
        CHECK(std::abs(pieces[0][i].volume - pieces[1][i].volume) < 0.05 / 5);
    }
}

/// What three strokes that cross, one of them curved and not all the way through, leave of a body.
struct Remains {
    std::vector<double> volumes = {}; // of the pieces, largest first
    double copies = 0, tets = 0;
};

/// Blade and tissue are moved by `move`, which maps lines to lines.
Remains cut_moved(const Body& body, const std::function<Vec3(Vec3)>& move) {
    const CutterPtr cutter = cutter_of(body);
    const Motion3 moved = [&](Vec3 p, double) { return move(p); };
    const Poses across = plane_poses({0.2, 1, 0.3}, {0.5, 0.45, 0.5}, {1, 0, 0});
    const Poses curved = [](double t) {
        return Edge{{0.45 + 0.1 * std::sin(3 * t), 1.3 * t - 0.1, 2}, {0.55, 1.3 * t - 0.1, 0.3}};
    };
    const Poses through = plane_poses({1, 0.1, 0.3}, {0.45, 0.5, 0.5}, {0, 0, 1});
    for (const Poses& poses : {across, curved, through}) {
        stroke(
            *cutter,
            [&](double t) {
                return Edge{move(poses(t).heel), move(poses(t).tip)};
            },
            40, moved);
    }
    CHECK(find_broken_invariant(*cutter) == "");
    Remains remains = {{}, double(cutter->mesh.copy_node.size()), double(cutter->material.tets.size())};
    for (const Piece& piece : pieces_of(*cutter)) {
        remains.volumes.push_back(piece.volume);
    }
    std::sort(remains.volumes.rbegin(), remains.volumes.rend());
    return remains;
}

void check_alike(const Remains& one, const Remains& other, double share) {
    REQUIRE(one.volumes.size() == 4);
    REQUIRE(other.volumes.size() == one.volumes.size());
    for (std::size_t i = 0; i < one.volumes.size(); ++i) {
        CHECK(std::abs(one.volumes[i] - other.volumes[i]) <= share);
    }
    CHECK(other.copies == doctest::Approx(one.copies).epsilon(20 * share));
    CHECK(other.tets == doctest::Approx(one.tets).epsilon(20 * share));
}

TEST_CASE("a body that was turned, stretched or sheared with the blade is cut as at rest") {
    const Body body = make_cube(5, 0.2, 4);
    const Remains rest = cut_moved(body, [](Vec3 p) { return p; });
    check_alike(rest,
                cut_moved(body,
                          [](Vec3 p) {
                              return Vec3{0.6 * p[0] - 0.8 * p[2] + 0.3, p[1], 0.8 * p[0] + 0.6 * p[2]};
                          }),
                1e-7);
    check_alike(rest, cut_moved(body, [](Vec3 p) { return Vec3{1.4 * p[0], 0.8 * p[1], 0.9 * p[2]}; }), 1e-3);
    check_alike(rest,
                cut_moved(body,
                          [](Vec3 p) {
                              return Vec3{p[0] + 0.4 * p[1], p[1] - 0.2 * p[2], p[2]};
                          }),
                1e-3);
}

TEST_CASE("a body whose tets and nodes are listed in another order is cut alike") {
    const Body body = make_cube(5, 0.2, 4);
    Body listed = body;
    std::mt19937 random(11);
    std::vector<Index> row_of(body.elements.nodes.size());
    std::iota(row_of.begin(), row_of.end(), 0);
    std::shuffle(row_of.begin(), row_of.end(), random);
    for (std::size_t node = 0; node < row_of.size(); ++node) {
        listed.elements.nodes[row(row_of[node])] = body.elements.nodes[node];
    }
    for (Tet& tet : listed.elements.tets) {
        for (Index& node : tet) {
            node = row_of[row(node)];
        }
    }
    std::shuffle(listed.elements.tets.begin(), listed.elements.tets.end(), random);
    const auto stay_put = [](Vec3 p) { return p; };
    check_alike(cut_moved(body, stay_put), cut_moved(listed, stay_put), 1e-6);
}

TEST_CASE("tissue that falls onto a blade at rest is cut in two") {
    const CutterPtr cutter = cutter_of(make_cube(5, 0.2, 5));
    const Edge blade = {{0.52, 2, -0.5}, {0.5, -1, -0.5}};
    const Motion3 fall = [](Vec3 p, double t) { return p - Vec3{0, 0, 2 * t}; };
    stroke(
        *cutter, [&](double) { return blade; }, 50, fall);
    CHECK(find_broken_invariant(*cutter) == "");
    CHECK(pieces_of(*cutter).size() == 2);
}

TEST_CASE("strokes outside the tissue, of no length or of no extent change nothing") {
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 6));
    const std::uint64_t before = hash_topology(*cutter);
    stroke(
        *cutter,
        [](double t) {
            return Edge{{2 + t, 0, 2}, {2 + t, 0, -1}};
        },
        10);
    stroke(
        *cutter,
        [](double) {
            return Edge{{0.5, 0.5, 2}, {0.5, 0.5, -1}};
        },
        10);
    stroke(
        *cutter,
        [](double t) {
            return Edge{{0.5, -1 + 3 * t, 3}, {0.5, -1 + 3 * t, 1.5}};
        },
        10);
    CHECK(hash_topology(*cutter) == before);

    place_blade(*cutter, 0, {{0.5, -1, 2}, {0.5, -1, -1}});
    const CutReport refused = sweep(
        *cutter,
        [](double) {
            return Edge{{0.5, 1, 2}, {0.5, 1, 2}};
        },
        2);
    CHECK(refused.refused == 2);
    CHECK(refused.reason != "");
    const CutReport lost = sweep(
        *cutter,
        [](double) {
            return Edge{{std::nan(""), 1, 2}, {0.5, 1, 2}};
        },
        3);
    CHECK(lost.refused == 3);
    CHECK(hash_topology(*cutter) == before);
}

TEST_CASE("the same strokes give the same bits, and others do not") {
    std::vector<std::uint64_t> hashes;
    for (const double height : {0.5, 0.5, 0.6}) {
        std::mt19937 random(3);
        const Motion3 waves = draw_waves(random, 0.05, 0.05);
        const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 8));
        stroke(*cutter, plane_poses({0.2, 1, 0.3}, {0.5, height, 0.5}, {1, 0, 0}), 30, waves);
        hashes.push_back(hash_topology(*cutter));
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] != hashes[2]);
}

} // namespace
} // namespace resect
