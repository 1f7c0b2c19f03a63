// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <map>
#include <numbers>
#include <set>

#include "cut/range_history.hpp"
#include "cut/saved_state.hpp"
#include "strokes.hpp"

namespace resect {
namespace {

/// A triangle by its points, the lowest first, its face and its piece.
using Shown = std::array<Index, 5>;

Shown make_shown(std::array<Index, 3> points, Index face, Index piece) {
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    return {points[0], points[1], points[2], face, piece};
}

/// The boundary of the material, from scratch.
std::vector<Shown> collect_boundary(Cutter& cutter) {
    std::vector<Shown> all;
    const std::span<const Index> piece = piece_of_copy(cutter);
    for (Index m = 0; m < cutter.material.tet_count(); ++m) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] >= 0) { continue; }
            const auto& [a, b, c] = face_corners[k];
            all.push_back(make_shown({tet.vertex[row(a)], tet.vertex[row(b)], tet.vertex[row(c)]},
                                     tet.label[k], piece[row(tet.copy)]));
        }
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::vector<Shown> collect_shown(const Surface& surface) {
    std::vector<Shown> all;
    for (std::size_t i = 0; i < surface.triangle.size(); ++i) {
        const auto& [a, b, c] = surface.triangle[i];
        all.push_back(make_shown({surface.point[row(a)], surface.point[row(b)], surface.point[row(c)]},
                                 surface.face[i], surface.piece[i]));
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Each point has one vertex for each face around it, and no vertex is left over.
bool has_one_vertex_a_face(const Surface& surface) {
    std::vector<std::set<Index>> faces(surface.point.size());
    for (std::size_t i = 0; i < surface.triangle.size(); ++i) {
        for (const Index v : surface.triangle[i]) {
            faces[row(v)].insert(surface.face[i]);
        }
    }
    std::set<std::pair<Index, Index>> met;
    for (std::size_t v = 0; v < faces.size(); ++v) {
        if (faces[v].size() != 1 || !met.insert({surface.point[v], *faces[v].begin()}).second) {
            return false;
        }
    }
    return true;
}

std::vector<Vec3f> scatter(std::mt19937& random, const Cutter& cutter, double size) {
    std::vector<Vec3f> u;
    for (std::size_t n = 0; n < cutter.mesh.node_reference.size(); ++n) {
        u.push_back(to_float(draw_vector(random, -size, size)));
    }
    return u;
}

/// Farthest from where the material says that its vertices are.
double find_error(const Cutter& cutter, const Surface& surface, std::span<const Vec3f> displacement) {
    double error = 0;
    for (std::size_t v = 0; v < surface.point.size(); ++v) {
        const Vec3 expected = displaced_position(cutter, surface.point[v], displacement);
        error = std::max(error, length(to_double(surface.position[v]) - expected));
    }
    return error;
}

TEST_CASE("the surface that followed the cuts is the boundary of the material") {
    std::mt19937 random(11);
    std::size_t largest = 0;
    for (int body = 0; body < 8; ++body) {
        const Body cube = make_cube(3 + body % 3, 0.2, unsigned(body));
        CutterSetup setup = make_setup(cube);
        setup.options.refine = body == 7 ? 1 : 0;
        const CutterPtr cutter = must(make_cutter(cube, setup));
        const Motion3 waves = draw_waves(random, 0, 0.08);
        const int seldom = 1 + 6 * (body % 3); // increments between two looks
        int increments = 0;
        for (int s = 0; s < 12; ++s) {
            const Poses poses = draw_stroke(random);
            place_blade(*cutter, 0, poses(0));
            for (int i = 0; i < 15; ++i, ++increments) {
                CutReport report;
                Delta delta;
                cutter->failing = i % 5 == 3 ? Stage::derive : Stage::none; // taken back, now and then
                sweep_blade(*cutter, 0, poses((i + 1) / 15.0), displacements(*cutter, waves, i / 15.0),
                            displacements(*cutter, waves, (i + 1) / 15.0), delta, report);
                if (increments % seldom != 0) { continue; }
                const std::vector<Vec3f> u = scatter(random, *cutter, 0.5);
                const Surface surface = update_surface(*cutter, u, 0);
                CAPTURE(body);
                CAPTURE(s);
                CAPTURE(i);
                REQUIRE(collect_shown(surface) == collect_boundary(*cutter));
                REQUIRE(has_one_vertex_a_face(surface));
                REQUIRE(find_error(*cutter, surface, u) < 1e-6);
                largest = std::max(largest, surface.triangle.size());
            }
            lift_blade(*cutter, 0);
        }
    }
    CHECK(largest > 2000);
}

TEST_CASE("a surface that is looked at for the first time after cuts is the same as one that followed them") {
    std::vector<std::vector<Shown>> shown;
    for (const bool follows : {false, true}) {
        std::mt19937 random(5);
        const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 2));
        for (int s = 0; s < 6; ++s) {
            stroke(*cutter, draw_stroke(random), 15);
            const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
            if (follows || s == 5) { update_surface(*cutter, none, 0); }
        }
        const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
        shown.push_back(collect_shown(update_surface(*cutter, none, 0)));
    }
    CHECK(shown[0].size() > 400);
    CHECK(shown[0] == shown[1]);
}

/// What a renderer keeps of a surface.
struct Mirror {
    std::vector<std::array<Index, 3>> triangle = {};
    std::vector<Index> face = {}, piece = {}, point = {};
    std::vector<Vec3f> rest = {};
    std::uint64_t revision = 0;
    std::size_t copied = 0, shown = 0; // rows of triangles, over all calls that found changes

    template <class T>
    static void copy(std::vector<T>& mine, std::span<const T> theirs, std::span<const Range> ranges) {
        mine.resize(theirs.size());
        for (const auto& [begin, end] : ranges) {
            REQUIRE(begin < end);
            REQUIRE(row(end) <= theirs.size());
            std::copy(theirs.begin() + begin, theirs.begin() + end, mine.begin() + begin);
        }
    }

    void follow(Cutter& cutter) {
        const std::vector<Vec3f> none(cutter.mesh.node_reference.size());
        const Surface surface = update_surface(cutter, none, revision);
        CHECK(surface.dirty.size() <= 16);
        CHECK(surface.dirty_vertices.size() <= 16);
        CHECK((revision < surface.revision) == !surface.dirty.empty());
        copy(triangle, surface.triangle, surface.dirty);
        copy(face, surface.face, surface.dirty);
        copy(piece, surface.piece, surface.dirty);
        copy(point, surface.point, surface.dirty_vertices);
        copy(rest, surface.rest, surface.dirty_vertices);
        for (const auto& [begin, end] : surface.dirty) {
            copied += row(end - begin);
        }
        if (revision < surface.revision) { shown += surface.triangle.size(); }
        revision = surface.revision;
        CHECK(std::equal(triangle.begin(), triangle.end(), surface.triangle.begin(), surface.triangle.end()));
        CHECK(std::equal(face.begin(), face.end(), surface.face.begin(), surface.face.end()));
        CHECK(std::equal(piece.begin(), piece.end(), surface.piece.begin(), surface.piece.end()));
        CHECK(std::equal(point.begin(), point.end(), surface.point.begin(), surface.point.end()));
        CHECK(std::equal(rest.begin(), rest.end(), surface.rest.begin(), surface.rest.end()));
    }
};

TEST_CASE("mirrors that copy only dirty ranges stay equal to the surface") {
    std::mt19937 random(21);
    const CutterPtr cutter = cutter_of(make_cube(8, 0.2, 4));
    Mirror every, seldom, late;
    every.follow(*cutter);
    seldom.follow(*cutter);
    late.follow(*cutter);
    every.copied = every.shown = 0;
    int increments = 0;
    for (int s = 0; s < 8; ++s) {
        const bool parts = s == 5;
        const Poses poses =
            parts ? plane_poses({1, 0.3, 0.2}, {0.3, 0.5, 0.5}, {0, 0, 1}) : draw_stroke(random);
        place_blade(*cutter, 0, poses(0));
        for (int i = 1; i <= 25; ++i) {
            const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
            CutReport report;
            Delta delta;
            sweep_blade(*cutter, 0, poses(i / 25.0), none, none, delta, report);
            every.follow(*cutter);
            if (++increments % 7 == 0) { seldom.follow(*cutter); }
        }
        lift_blade(*cutter, 0);
    }
    CHECK(increments == 200);
    CHECK(count_pieces(*cutter) > 1);
    const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
    CHECK(collect_shown(update_surface(*cutter, none, 0)) == collect_boundary(*cutter));
    CHECK(every.revision > 70); // more than the history keeps
    late.follow(*cutter);
    CHECK(every.copied < every.shown / 10);
}

TEST_CASE("a mirror follows a state that is restored, and what is cut after it") {
    std::mt19937 random(61);
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 7));
    Mirror mirror;
    stroke(*cutter, draw_stroke(random), 15);
    mirror.follow(*cutter);
    const std::vector<std::array<Index, 3>> before = mirror.triangle;
    const std::shared_ptr<const CutterState> saved = save_state(*cutter);
    stroke(*cutter, draw_stroke(random), 15);
    mirror.follow(*cutter);
    CHECK(mirror.triangle.size() > before.size());
    restore_state(*cutter, *saved);
    mirror.follow(*cutter);
    CHECK(mirror.triangle.size() == before.size());
    stroke(*cutter, draw_stroke(random), 15);
    mirror.follow(*cutter);
    const std::vector<Vec3f> u = scatter(random, *cutter, 0.5);
    const Surface surface = update_surface(*cutter, u, 0);
    CHECK(collect_shown(surface) == collect_boundary(*cutter));
    CHECK(find_error(*cutter, surface, u) < 1e-6);
}

/// Pairs of torn faces that were one.
std::vector<std::array<TetFace, 2>> find_torn_pairs(const Cutter& cutter) {
    std::map<std::array<Vec3, 3>, TetFace> met; // by places at rest, sorted
    std::vector<std::array<TetFace, 2>> pairs;
    for (Index m = 0; m < cutter.material.tet_count(); ++m) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] >= 0 || tet.label[k] == 0) { continue; }
            std::array<Vec3, 3> places = {};
            for (std::size_t i = 0; i < 3; ++i) {
                places[i] = cutter.material.at(tet, row(face_corners[k][i]));
            }
            std::sort(places.begin(), places.end());
            const auto [at, is_new] = met.emplace(places, TetFace{m, k});
            if (!is_new) { pairs.push_back({at->second, TetFace{m, k}}); }
        }
    }
    return pairs;
}

TEST_CASE("a surface that shrinks leaves no gaps in its rows") {
    std::mt19937 random(51);
    const CutterPtr cutter = cutter_of(make_cube(6, 0.2, 5));
    Mirror mirror;
    for (int s = 0; s < 6; ++s) {
        stroke(*cutter, draw_stroke(random), 15);
        mirror.follow(*cutter);
    }
    std::vector<std::array<TetFace, 2>> pairs = find_torn_pairs(*cutter);
    REQUIRE(pairs.size() > 100);
    std::shuffle(pairs.begin(), pairs.end(), random);
    // Made by hand: material that heals (its vertices stay double), and some that is torn anew after that.
    const std::size_t before = mirror.triangle.size();
    while (!pairs.empty()) {
        for (int i = 0; i < 20 && !pairs.empty(); ++i, pairs.pop_back()) {
            const auto& [a, b] = pairs.back();
            MaterialTet& one = cutter->material.edit_tet(a.tet);
            MaterialTet& other = cutter->material.edit_tet(b.tet);
            const bool heals = i % 4 != 0;
            one.link[a.face] = heals ? make_link(b.tet, b.face) : -1;
            other.link[b.face] = heals ? make_link(a.tet, a.face) : -1;
            one.label[a.face] = heals ? 0 : 99;
            other.label[b.face] = heals ? 0 : -99;
            cutter->surface.stale_tets.add(a.tet);
            cutter->surface.stale_tets.add(b.tet);
        }
        ++cutter->revision;
        mirror.follow(*cutter);
        const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
        const Surface surface = update_surface(*cutter, none, 0);
        REQUIRE(collect_shown(surface) == collect_boundary(*cutter));
        REQUIRE(has_one_vertex_a_face(surface));
        REQUIRE(find_error(*cutter, surface, none) < 1e-6);
    }
    CHECK(mirror.triangle.size() + 150 <= before);
}

TEST_CASE("the surface stays closed and oriented, bit for bit, however its nodes are thrown about") {
    std::mt19937 random(31);
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 6));
    const Motion3 waves = draw_waves(random, 0.02, 0.08);
    for (int s = 0; s < 20; ++s) {
        stroke(*cutter, draw_stroke(random), 15, waves);
        const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
        update_surface(*cutter, none, 0);
    }
    for (int trial = 0; trial < 5; ++trial) {
        const std::vector<Vec3f> u = scatter(random, *cutter, 3);
        const Surface surface = update_surface(*cutter, u, 0);
        std::map<Index, Vec3f> place; // [point]
        std::size_t shared = 0;
        for (std::size_t v = 0; v < surface.point.size(); ++v) {
            const auto [at, is_new] = place.emplace(surface.point[v], surface.position[v]);
            shared += is_new ? 0 : 1;
            REQUIRE(std::memcmp(&at->second, &surface.position[v], sizeof(Vec3f)) == 0);
        }
        CHECK(shared > 500);
        std::map<std::pair<Index, Index>, int> turns; // [edge by points] one direction less the other
        for (const auto& triangle : surface.triangle) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Index from = surface.point[row(triangle[k])];
                const Index to = surface.point[row(triangle[(k + 1) % 3])];
                turns[std::minmax(from, to)] += from < to ? 1 : -1;
            }
        }
        CHECK(std::all_of(turns.begin(), turns.end(), [](const auto& edge) { return edge.second == 0; }));
    }
}

double degrees_between(const Vec3& a, const Vec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

TEST_CASE("normals are smooth over a planar sheet and break at its lips") {
    const CutterPtr cutter = cutter_of(make_cube(4, 0, 0));
    // Across cells, farther from all nodes than the sheet would snap to.
    const Vec3 normal = direction(Vec3{1, 0.06, 0.04});
    stroke(*cutter, plane_poses(normal, {0.37, 0.5, 0.5}, {0, 1, 0}), 40);
    const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
    const Surface surface = update_surface(*cutter, none, 0);

    std::map<std::pair<Index, Index>, Vec3> normal_at; // [point, face]
    for (std::size_t i = 0; i < surface.triangle.size(); ++i) {
        for (const Index v : surface.triangle[i]) {
            normal_at[{surface.point[row(v)], surface.face[i]}] = to_double(surface.normal[row(v)]);
        }
    }
    int on_sheet = 0, on_lips = 0;
    for (const auto& [at, n] : normal_at) {
        const auto& [point, face] = at;
        CHECK(length(n) == doctest::Approx(1).epsilon(1e-5));
        if (face == 0) { continue; }
        ++on_sheet;
        const double tilt = degrees_between(n, normal);
        CHECK(std::min(tilt, 180 - tilt) < 1);
        const auto outer = normal_at.find({point, 0});
        if (outer == normal_at.end()) { continue; }
        ++on_lips;
        CHECK(degrees_between(n, outer->second) > 60);
    }
    CHECK(on_sheet > 2 * 60);
    CHECK(on_lips > 2 * 30);
    CHECK(on_lips < on_sheet);
}

TEST_CASE("the two sides of a half cut have normals of their own at its front") {
    const CutterPtr cutter = cutter_of(make_cube(6, 0, 0));
    stroke(
        *cutter,
        [](double t) {
            return Edge{{0.42, -0.2 + 0.7 * t, 2}, {0.42, -0.2 + 0.7 * t, -1}};
        },
        40);
    const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
    const Surface surface = update_surface(*cutter, none, 0);
    std::map<Index, std::array<Vec3, 2>> sides; // [point]
    for (std::size_t i = 0; i < surface.triangle.size(); ++i) {
        if (surface.face[i] == 0) { continue; }
        for (const Index v : surface.triangle[i]) {
            sides[surface.point[row(v)]][surface.face[i] > 0 ? 1 : 0] = to_double(surface.normal[row(v)]);
        }
    }
    int on_front = 0;
    for (const auto& [point, normal] : sides) {
        if (length(normal[0]) == 0 || length(normal[1]) == 0) { continue; }
        ++on_front;
        CHECK(degrees_between(normal[0], normal[1]) > 150);
    }
    CHECK(on_front > 6);
}

TEST_CASE(
    "coordinates in the material are those at rest, and deformation changes them no more than topology") {
    std::mt19937 random(41);
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 3));
    stroke(*cutter, draw_stroke(random), 20);
    const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
    const Surface before = update_surface(*cutter, none, 0);
    const std::uint64_t revision = before.revision;
    for (std::size_t v = 0; v < before.rest.size(); ++v) {
        CHECK(before.rest[v] == to_float(cutter->material.rest[row(before.point[v])]));
    }
    CHECK(std::equal(before.rest.begin(), before.rest.end(), before.position.begin(), before.position.end()));
    const std::vector<Vec3f> rest(before.rest.begin(), before.rest.end());
    const std::vector<Vec3f> u = scatter(random, *cutter, 1);
    const Surface after = update_surface(*cutter, u, revision);
    CHECK(std::equal(rest.begin(), rest.end(), after.rest.begin(), after.rest.end()));
    CHECK_FALSE(std::equal(rest.begin(), rest.end(), after.position.begin(), after.position.end()));
    CHECK(after.revision == revision);
    CHECK(after.dirty.empty());
    CHECK(after.dirty_vertices.empty());
    CHECK(after.update_us == 0);
}

std::vector<std::pair<Index, Index>> list(std::span<const Range> ranges) {
    std::vector<std::pair<Index, Index>> all;
    for (const Range& range : ranges) {
        all.emplace_back(range.begin, range.end);
    }
    return all;
}

TEST_CASE("a history answers with what changed since, within the rows there are") {
    using Ranges = std::vector<std::pair<Index, Index>>;
    RangeHistory history;
    history.restart(3);
    CHECK(list(history.since(3, 10)).empty());
    CHECK(list(history.since(2, 10)) == Ranges{{0, 10}});
    std::vector<Index> rows = {8, 2, 3, 2};
    history.add(5, rows);
    rows = {4, 9};
    history.add(6, rows);
    CHECK(list(history.since(3, 10)) == Ranges{{2, 5}, {8, 10}});
    CHECK(list(history.since(4, 10)) == Ranges{{2, 5}, {8, 10}}); // no revision of its own
    CHECK(list(history.since(5, 10)) == Ranges{{4, 5}, {9, 10}});
    CHECK(list(history.since(6, 10)).empty());
    CHECK(list(history.since(3, 9)) == Ranges{{2, 5}, {8, 9}});
    CHECK(list(history.since(5, 4)).empty());
}

TEST_CASE("a history closes the smallest gaps and forgets the oldest revisions") {
    using Ranges = std::vector<std::pair<Index, Index>>;
    RangeHistory history;
    history.restart(1);
    std::vector<Index> rows;
    for (Index i = 0; i < 30; ++i) {
        rows.push_back(i < 15 ? 10 * i : 1000 + 100 * i);
    }
    history.add(2, rows);
    const auto ranges = list(history.since(1, 10000));
    REQUIRE(ranges.size() == 16);
    CHECK(ranges[0] == std::pair<Index, Index>{0, 141});
    CHECK(ranges[1] == std::pair<Index, Index>{2500, 2501});
    for (std::uint64_t revision = 3; revision <= 65; ++revision) {
        rows = {Index(revision)};
        history.add(revision, rows);
    }
    CHECK(list(history.since(1, 10000)).size() == 16); // 64 revisions
    CHECK(list(history.since(2, 10000)) == Ranges{{3, 66}});
    rows = {7};
    history.add(66, rows);
    CHECK(list(history.since(1, 10000)) == Ranges{{0, 10000}});
    CHECK(list(history.since(2, 10000)) == Ranges{{3, 66}});
}

} // namespace
} // namespace resect
