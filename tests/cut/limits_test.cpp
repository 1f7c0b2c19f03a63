// SPDX-License-Identifier: Apache-2.0
#include "base/hash.hpp"
#include "cut/stages.hpp"
#include "cut/transaction.hpp"
#include "strokes.hpp"

namespace resect {
namespace {

CutterPtr cutter_with(const Body& body, CutOptions options) {
    CutterSetup setup = make_setup(body);
    setup.options = options;
    return must(make_cutter(body, std::move(setup)));
}

/// Area of the sheets, one side, m^2.
double torn_area(const Cutter& cutter) {
    double area = 0;
    for (Index t = 0; t < cutter.material.tet_count(); ++t) {
        for (std::size_t k = 0; k < 4; ++k) {
            const MaterialTet& tet = cutter.material.tet(t);
            if (tet.link[k] < 0 && tet.label[k] > 0) {
                area += length(face_normal(cutter.material, t, k)) / 2;
            }
        }
    }
    return area;
}

/// A blade that hangs into the top of a cube by `depth` and goes along y.
Poses incision(double x, double depth) {
    return [=](double t) {
        const Vec3 tip = {x + 0.05 * (-0.2 + 1.4 * t), -0.2 + 1.4 * t, 1 - depth};
        return Edge{tip + Vec3{0, 0, 3}, tip};
    };
}

/// Mean depth that an incision tears, in elements, over six jittered cubes of eight cells.
double torn_depth(Front front, double depth_in_elements) {
    constexpr int n = 8;
    double sum = 0;
    for (unsigned seed = 0; seed < 6; ++seed) {
        const CutterPtr cutter = cutter_with(make_cube(n, 0.2, seed), {.front = front});
        stroke(*cutter, incision(0.45 + 0.02 * seed, depth_in_elements / n), 200);
        CHECK(find_broken_invariant(*cutter) == "");
        CHECK(pieces_of(*cutter).size() == 1);
        sum += torn_area(*cutter);
    }
    return n * sum / 6;
}

TEST_CASE("a soft tip tears as deep as the blade goes, a held one less") {
    for (const double depth : {0.3, 0.6, 0.9, 1.3, 1.8, 2.5}) {
        const double soft = torn_depth(Front::soft, depth);
        const double hold = torn_depth(Front::hold, depth);
        MESSAGE("depth " << depth << " h: soft " << soft << " h, hold " << hold << " h");
        CHECK(soft == doctest::Approx(depth).epsilon(0.3));
        CHECK(hold < soft + 0.05);
    }
}

/// Cuts a jittered cube in one stroke, or in two of which the second begins where the first ended.
std::uint64_t cut_in_two_strokes(double lifted_at, Index second_blade, CutReport& report) {
    const CutterPtr cutter = cutter_with(make_cube(4, 0.2, 8), {});
    const Poses poses = [](double t) {
        const Vec3 at = {0.53, -0.25 + 1.5 * t, 0.5};
        return Edge{at + Vec3{0, 0, 2}, at - Vec3{0, 0, 2}};
    };
    const auto between = [&](double from, double to) {
        return [=](double t) { return poses(from + t * (to - from)); };
    };
    place_blade(*cutter, 0, poses(0));
    report = sweep(*cutter, between(0, lifted_at), 30);
    Index blade = 0;
    if (second_blade >= 0) {
        lift_blade(*cutter, 0);
        blade = second_blade;
        place_blade(*cutter, blade, poses(lifted_at), displacements(*cutter, stay, 0));
    }
    const CutReport rest = sweep(*cutter, between(lifted_at, 1), 30, stay, blade);
    report.copies_added += rest.copies_added;
    report.pieces = static_cast<Index>(pieces_of(*cutter).size());
    CHECK(find_broken_invariant(*cutter) == "");
    return hash_topology(*cutter);
}

TEST_CASE("a blade that is put back where one was lifted inside the tissue goes on with its stroke") {
    for (const double lifted_at : {0.2, 0.37, 0.45, 0.5, 0.61}) {
        CutReport whole, again, other;
        const std::uint64_t hash = cut_in_two_strokes(lifted_at, -1, whole);
        CHECK(whole.pieces == 2);
        CHECK(cut_in_two_strokes(lifted_at, 0, again) == hash);
        CHECK(cut_in_two_strokes(lifted_at, 3, other) == hash);
        CHECK(again.copies_added == whole.copies_added);
    }
}

TEST_CASE("one stroke that comes back to its own cut crosses it") {
    constexpr double turn = 2 * 3.14159265358979;
    const auto upright = [](const Vec3& at) {
        const Vec3 along = {0.05, 0.03, 1};
        return Edge{at + 5.0 * along, at - 5.0 * along};
    };
    const Poses circle = [=](double t) {
        const double a = 1.1 * turn * t;
        return upright({0.5 + 0.3 * std::cos(a), 0.5 + 0.3 * std::sin(a), 0.5});
    };
    const Poses eight = [=](double t) {
        const double a = 1.1 * turn * t + 0.3;
        return upright({0.5 + 0.33 * std::sin(a), 0.5 + 0.3 * std::sin(2 * a), 0.5});
    };
    const Poses spiral = [=](double t) {
        const double a = 2 * turn * t;
        const double r = 0.1 + 0.3 * t;
        return upright({0.5 + r * std::cos(a), 0.5 + r * std::sin(a), 0.5});
    };
    const std::pair<const Poses*, std::size_t> cases[] = {{&circle, 2}, {&eight, 3}, {&spiral, 1}};
    for (const auto& [poses, expected] : cases) {
        const CutterPtr cutter = cutter_of(make_cube(8, 0.2, 3));
        stroke(*cutter, *poses, 800);
        CHECK(pieces_of(*cutter).size() == expected);
        CHECK(find_broken_invariant(*cutter) == "");
    }
}

/// Of everything that an increment changes and later ones go by.
std::uint64_t hash_all(const Cutter& cutter) {
    Hash hash;
    hash.add(hash_topology(cutter)).add(cutter.revision);
    for (const auto* rows : {&cutter.first_tet, &cutter.sibling, &cutter.tet_count, &cutter.material.any_tet,
                             &cutter.pieces.of_copy}) {
        hash.add(rows->view());
    }
    hash.add(cutter.material.grain.view()).add(cutter.material.on_cut.view());
    for (const Blade& blade : cutter.blades) {
        for (const SheetMark& mark : blade.sheet) {
            hash.add(mark.stroke).add(mark.normal);
        }
        hash.add(blade.pending.size());
        for (Index u = 0; u < cutter.material.vertex_count(); ++u) {
            for (Index w = u + 1; w < cutter.material.vertex_count(); ++w) {
                const Crossing* found = blade.pending.find(u, w);
                if (found != nullptr) { hash.add(u).add(w).add(found->t).add(found->height); }
            }
        }
    }
    return hash.value();
}

TEST_CASE("an increment that fails at any stage is taken back whole") {
    const Stage stages[] = {Stage::refine, Stage::detect, Stage::bisect, Stage::tear, Stage::derive};
    const auto poses = plane_poses({0.4, 1, 0.2}, {0.5, 0.5, 0.5}, {1, 0, 0});
    for (const Stage stage : stages) {
        const CutterPtr cutter = cutter_with(make_cube(4, 0.2, 5), {.refine = 1});
        place_blade(*cutter, 0, poses(0));
        place_blade(*cutter, 1, poses(0.2));
        Delta delta;
        CutReport report;
        int failed = 0;
        int changed = 0;
        for (int i = 1; i <= 30; ++i) {
            const std::vector<Vec3f> rest(cutter->mesh.node_reference.size());
            const std::uint64_t before = hash_all(*cutter);
            const Index refused = report.refused;
            const Index copies = report.copies_added;
            cutter->failing = i % 2 == 0 ? stage : Stage::none;
            sweep_blade(*cutter, 0, poses(i / 30.0), rest, rest, delta, report);
            changed += hash_all(*cutter) != before ? 1 : 0;
            if (report.refused == refused) { continue; }
            ++failed;
            CHECK(hash_all(*cutter) == before);
            CHECK(delta.copies.empty());
            CHECK(delta.touched_nodes.empty());
            CHECK(report.copies_added == copies);
            CHECK(report.reason.find("told to fail") != std::string::npos);
        }
        CHECK(failed > 5);
        CHECK(changed > 5);
        CHECK(find_broken_invariant(*cutter) == "");
        cutter->failing = Stage::none;
        stroke(*cutter, poses, 40);
        CHECK(pieces_of(*cutter).size() == 2);
    }
}

TEST_CASE("what an increment leaves broken is found by the checks of every build") {
    const CutterPtr cutter = cutter_of(make_cube(3, 0.1, 2));
    stroke(*cutter, plane_poses({1, 0.2, 0.1}, {0.5, 0.5, 0.5}, {0, 1, 0}), 20);
    REQUIRE(find_fault(*cutter) == nullptr);
    const auto faulty = [&](auto spoil) {
        open_state(*cutter);
        spoil();
        const bool found = find_fault(*cutter) != nullptr;
        take_back_state(*cutter);
        return found;
    };
    const Index linked = [&] {
        Index t = 0;
        while (cutter->material.tet(t).link[0] < 0) {
            ++t;
        }
        return t;
    }();
    CHECK(faulty([&] { cutter->material.edit_tet(linked).link[0] = make_link(linked, 1); }));
    CHECK(faulty([&] { cutter->material.edit_tet(linked).volume *= 1.1; }));
    CHECK(faulty([&] {
        std::swap(cutter->material.edit_tet(linked).vertex[0], cutter->material.edit_tet(linked).vertex[1]);
    }));
    CHECK(faulty([&] { cutter->mesh.copy_weight.edit(0) *= 0.01; }));
    CHECK(faulty([&] {
        cutter->mesh.copy_fraction.edit(0) *= 0.9;
        cutter->mesh.copy_weight.edit(0);
    }));
    CHECK(faulty([&] { cutter->mesh.node_mass.edit(3) = 0; }));
    CHECK(faulty([&] { std::swap(cutter->mesh.copy_node.edit(0)[0], cutter->mesh.copy_node.edit(0)[1]); }));
    CHECK(find_fault(*cutter) == nullptr);
    CHECK(find_broken_invariant(*cutter) == "");
}

TEST_CASE("however often one place is cut, its material stays bounded") {
    const CutterPtr cutter = cutter_of(make_cube(2, 0.1, 1));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> offset(0.4, 0.6);
    std::uniform_real_distribution<double> tilt(-1, 1);
    Index largest = 0;
    Index half_way = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3 normal = {tilt(random), tilt(random), tilt(random)};
        stroke(*cutter,
               plane_poses(normal, {offset(random), offset(random), offset(random)}, {tilt(random), 1, 0.3}),
               20);
        if (i == 29) { half_way = cutter->material.tet_count(); }
    }
    for (const Index count : cutter->tet_count) {
        largest = std::max(largest, count);
    }
    MESSAGE("material tets of the fullest of 48 elements: " << largest << "; in all " << half_way
                                                            << " after 30 strokes, "
                                                            << cutter->material.tet_count() << " after 60");
    CHECK(largest < 450); // twice the crowd, and what one increment adds
    CHECK(cutter->material.tet_count() < 1.3 * half_way);
    CHECK(find_broken_invariant(*cutter) == "");
}

TEST_CASE("refinement halves the edges of the material at a cut and leaves the elements alone") {
    const auto facets = [](int refine) {
        const CutterPtr cutter = cutter_with(make_cube(4, 0.2, 3), {.refine = refine});
        const CutReport report = stroke(*cutter, plane_poses({1, 0.2, 0.1}, {0.52, 0.5, 0.5}, {0, 1, 0}), 60);
        CHECK(find_broken_invariant(*cutter) == "");
        CHECK(pieces_of(*cutter).size() == 2);
        int count = 0;
        for (const MaterialTet& tet : cutter->material.tets) {
            for (std::size_t k = 0; k < 4; ++k) {
                count += tet.link[k] < 0 && tet.label[k] > 0 ? 1 : 0;
            }
        }
        return std::pair(count, report.elements_cut);
    };
    const auto coarse = facets(0);
    const auto fine = facets(1);
    const auto finer = facets(2);
    MESSAGE("facets of the sheet: " << coarse.first << ", " << fine.first << ", " << finer.first);
    CHECK(fine.first > 2 * coarse.first);
    CHECK(finer.first > 1.5 * fine.first);
    CHECK(std::abs(fine.second - coarse.second) < 0.1 * coarse.second);
}

} // namespace
} // namespace resect
