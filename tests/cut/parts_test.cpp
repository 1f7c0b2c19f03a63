// SPDX-License-Identifier: Apache-2.0
#include "cut/pieces.hpp"
#include "cut/separate.hpp"
#include "cut/stages.hpp"
#include "strokes.hpp"

namespace resect {
namespace {

int count_separating(unsigned zero, unsigned edges_counted) {
    int count = 0;
    for (unsigned crossed = 0; crossed < 64; ++crossed) {
        const bool counted = (crossed & ~edges_counted) == 0;
        if (counted && find_side(zero, crossed) != 0) { ++count; }
    }
    return count;
}

TEST_CASE("26 of 64, 4 of 8 and 1 of 2 patterns of crossed edges separate a tet") {
    CHECK(count_separating(0b0000, 0b111111) == 26);
    CHECK(count_separating(0b0001, 0b111000) == 4); // edges 12, 13, 23
    CHECK(count_separating(0b0011, 0b100000) == 1); // edge 23
    CHECK(count_separating(0b0111, 0b111111) == 0);
    CHECK(count_separating(0b1111, 0b111111) == 0);
}

TEST_CASE("the sides of a separated tet are its corners that uncrossed edges join") {
    CHECK(find_side(0b0000, 0b000111) == 0b0001); // corner 0 alone
    CHECK(find_side(0b0000, 0b011110) == 0b0011); // 0, 1 from 2, 3
    CHECK(find_side(0b0001, 0b011000) == 0b0010); // corner 0 on the sheet, 1 alone
}

TEST_CASE("the origin lies in a triangle or not, and shared sides decide it the same way from both") {
    CHECK(holds_origin({-1, -1}, {2, -1}, {-1, 2}));
    CHECK_FALSE(holds_origin({1, 1}, {2, 1}, {1, 2}));
    CHECK_FALSE(holds_origin({-1, 0}, {-1, 0}, {1, 1}));
    // A fan around the origin with points on the axes, corners and the origin itself: one triangle holds it.
    const GridPoint fan[] = {{4, 0}, {4, 4}, {0, 4}, {-4, 4}, {-4, 0}, {-4, -4}, {0, -4}, {4, -4}};
    for (const GridPoint& hub : {GridPoint{0, 0}, GridPoint{1, 1}, GridPoint{0, 2}, GridPoint{-3, 0}}) {
        int holding = 0;
        for (unsigned i = 0; i < 8; ++i) {
            holding += holds_origin(hub, fan[i], fan[(i + 1) % 8]) ? 1 : 0;
        }
        CHECK(holding == 1);
    }
}

TEST_CASE("an edge map keeps what it was given through growth and erasure") {
    EdgeMap<int> map;
    for (int i = 0; i < 500; ++i) {
        map.set(i, i + 1 + i % 7, i);
    }
    for (int i = 0; i < 500; i += 2) {
        map.erase(i + 1 + i % 7, i);
    }
    CHECK(map.size() == 250);
    int kept = 0;
    for (int i = 0; i < 500; ++i) {
        const int* found = map.find(i + 1 + i % 7, i);
        CHECK((found != nullptr) == (i % 2 == 1));
        if (found != nullptr) { kept += *found == i ? 1 : 0; }
    }
    CHECK(kept == 250);
    map.clear();
    CHECK(map.find(1, 3) == nullptr);
}

TEST_CASE("rows and edge maps take back what was changed since they were opened") {
    Rows<int> rows;
    for (const int value : {10, 2, 3}) {
        rows.push_back(value);
    }
    const Rows<int> before = rows;
    rows.open();
    rows.edit(1) = 20;
    rows.edit(1) = 21;
    rows.push_back(4);
    rows.edit(3) = 40;
    std::vector<std::size_t> changed;
    rows.each_changed([&](std::size_t at) { changed.push_back(at); });
    CHECK(changed == std::vector<std::size_t>{1, 3});
    rows.take_back();
    CHECK(rows == before);

    EdgeMap<int> map;
    for (int i = 0; i < 40; ++i) {
        map.set(i, 100, i);
    }
    map.open();
    for (int i = 0; i < 200; ++i) {
        map.set(i, 100, -1);
    }
    for (int i = 0; i < 20; ++i) {
        map.erase(i, 100);
    }
    map.set(3, 100, 7);
    map.take_back();
    CHECK(map.size() == 40);
    int same = 0;
    for (int i = 0; i < 40; ++i) {
        same += map.at(100, i) == i ? 1 : 0;
    }
    CHECK(same == 40);
}

TEST_CASE("a blade's frame stays orthonormal and turns no more than its edge") {
    BladeFrame frame = make_frame({{0, 0, 1}, {0, 0, 0}});
    const Vec3 start = frame.across1;
    for (int i = 1; i <= 100; ++i) {
        const double a = 0.01 * i;
        frame = carry_frame(frame, {{std::sin(a), 0, std::cos(a)}, {0, 0, 0}});
    }
    CHECK(dot(frame.across1, frame.along) == doctest::Approx(0).epsilon(1e-14));
    CHECK(length(frame.across1) == doctest::Approx(1));
    CHECK(length(cross(frame.across1, frame.across2) - frame.along) < 1e-14);
    CHECK(std::acos(dot(frame.across1, start)) <= 1 + 1e-9);
    const BladeFrame about = carry_frame(frame, {{0, 0, 0}, {std::sin(1.0), 0, std::cos(1.0)}});
    CHECK(length(cross(about.across1, about.across2) - about.along) < 1e-9);
}

TEST_CASE("a support is found inside an element, snapped to its boundary, and not outside") {
    const Tet element = {7, 3, 9, 1};
    const std::array<Vec3, 4> p = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const Support inside = find_support(element, p, {0.2, 0.3, 0.1}, 1e-9);
    CHECK(weight_of(inside, 7) == doctest::Approx(0.4));
    CHECK(weight_of(inside, 9) == doctest::Approx(0.3));
    const Support edge = find_support(element, p, {0.25, 1e-12, -1e-12}, 1e-9);
    CHECK(edge.node == std::array<Index, 4>{7, 3, -1, -1});
    CHECK(find_support(element, p, {0.5, 0.6, 0}, 1e-9).node[0] == -1);
    const Support middle = interpolate(inside, edge, 0.5);
    CHECK(weight_of(middle, 3) == doctest::Approx(0.225));
}

/// Puts a blade on duty without a sweep: tags and crossings are set by hand.
Blade& blade_by_hand(Cutter& cutter) {
    place_blade(cutter, 0, {{0, 0, 1}, {0, 0, 0}});
    return cutter.blades[0];
}

/// Which of three blocks of cells that meet at the middle of a cube of two cells a tet lies in.
Index block_of(const Cutter& cutter, Index t) {
    const MaterialTet& tet = cutter.material.tet(t);
    Vec3 middle = {};
    for (std::size_t k = 0; k < 4; ++k) {
        middle += 0.25 * cutter.material.at(tet, k);
    }
    return middle[0] < 0.5 ? 0 : (middle[1] < 0.5 ? 1 : 2);
}

TEST_CASE("a star that falls into three parts at once becomes three vertices") {
    const CutterPtr cutter = cutter_of(make_cube(2, 0, 0));
    cutter->scratch.torn.clear();
    for (Index t = 0; t < cutter->material.tet_count(); ++t) {
        for (std::size_t k = 0; k < 4; ++k) {
            const Index link = cutter->material.tet(t).link[k];
            if (link < 0 || block_of(*cutter, t) == block_of(*cutter, tet_of(link))) { continue; }
            cutter->scratch.torn.push_back({t, k});
            cutter->scratch.torn.push_back({tet_of(link), face_of(link)});
            cutter->material.edit_tet(t).link[k] = -1;
            cutter->material.edit_tet(tet_of(link)).link[face_of(link)] = -1;
        }
    }
    part_torn_vertices(*cutter);
    Delta delta;
    CutReport report;
    derive_simulation(*cutter, delta, report);
    split_pieces(*cutter);
    CHECK(find_broken_invariant(*cutter) == "");
    CHECK(pieces_of(*cutter).size() == 3);
    std::array<Index, 3> own = {-1, -1, -1};
    bool alike = true;
    for (Index t = 0; t < cutter->material.tet_count(); ++t) {
        for (const Index v : cutter->material.tet(t).vertex) {
            if (cutter->material.rest[row(v)] != Vec3{0.5, 0.5, 0.5}) { continue; }
            Index& known = own[row(block_of(*cutter, t))];
            if (known < 0) { known = v; }
            alike = alike && known == v;
        }
    }
    CHECK(alike);
    CHECK(own[0] != own[1]);
    CHECK(own[1] != own[2]);
    CHECK(own[0] != own[2]);
}

TEST_CASE("a vertex that is split takes its crossings along") {
    const CutterPtr cutter = cutter_of(make_cube(2, 0, 0));
    Blade& blade = blade_by_hand(*cutter);
    const MaterialTet& tet = cutter->material.tet(0);
    const Index v = tet.vertex[0];
    const Index other = tet.vertex[1];
    const double from_lower = 0.3;
    blade.pending.set(v, other, {.t = from_lower});
    const Index star[] = {0};
    detach_star(*cutter, v, star);
    const Index twin = cutter->material.vertex_count() - 1;
    REQUIRE(blade.pending.find(twin, other) != nullptr);
    const double from_other = other < v ? from_lower : 1 - from_lower;
    CHECK(blade.pending.find(twin, other)->t == doctest::Approx(from_other)); // twins have the highest number
    CHECK(blade.pending.find(v, other)->t == from_lower);
}

TEST_CASE("a crossing of another blade moves to the half of the edge that holds it") {
    const CutterPtr cutter = cutter_of(make_cube(1, 0, 0));
    place_blade(*cutter, 0, {{0, 0, 1}, {0, 0, 0}});
    place_blade(*cutter, 1, {{0, 0, 1}, {0, 0, 0}});
    Blade& blade = cutter->blades[0];
    const Tet vertex = cutter->material.tet(0).vertex;
    const auto [low, high] = std::minmax(vertex[2], vertex[3]);
    // Blade 0 separates corners 2 and 3 of a tet whose other corners lie on its sheet.
    blade.sheet.edit(row(vertex[0])).stroke = blade.sheet.edit(row(vertex[1])).stroke = blade.stroke;
    blade.pending.set(low, high, {.t = 0.5});
    const MaterialMesh& material = cutter->material;
    cutter->blades[1].pending.set(
        low, high,
        {.t = 0.2, .expires = 1, .normal = direction(material.rest[row(high)] - material.rest[row(low)])});
    cutter->scratch.queue.clear();
    cutter->scratch.dirty.clear();
    cutter->scratch.queued.clear(cutter->material.tets.size());
    const std::vector<Vec3f> rest(cutter->mesh.node_reference.size());
    cutter->scratch.tissue = rest;
    queue_tet(*cutter, 0);
    bisect_separated(*cutter, blade);
    const Index z = 8;
    REQUIRE(cutter->material.vertex_count() == 9);
    CHECK(blade.pending.size() == 0);
    CHECK(cutter->blades[1].pending.find(low, high) == nullptr);
    REQUIRE(cutter->blades[1].pending.find(low, z) != nullptr);
    CHECK(cutter->blades[1].pending.find(low, z)->t == doctest::Approx(0.4));
    CHECK(find_broken_invariant(*cutter) == "");
}

} // namespace
} // namespace resect
