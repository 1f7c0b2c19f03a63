// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "strokes.hpp"

namespace resect {
namespace {

Poses across_x(double x) { return plane_poses({1, 0.2, 0.1}, {x, 0.5, 0.5}, {0, 1, 0}); }
Poses across_y(double y) { return plane_poses({0.1, 1, 0.2}, {0.5, y, 0.5}, {0, 0, 1}); }

/// A lattice-like body: the part of a cube below a slanted plane and left of a dent, as its own bisection
/// made it; some elements are half empty, and some hold two parts.
Body make_partial_body() {
    const Body cube = make_cube(4, 0, 0);
    const CutterPtr cutter = cutter_of(cube);
    stroke(*cutter, plane_poses({0.3, 0.2, 1}, {0.5, 0.5, 0.77}, {1, 0, 0}), 40);
    const auto notch = [](double y) {
        return [y](double t) { return Edge{{-0.5 + 1.1 * t, y, 2}, {-0.5 + 1.1 * t, y, -1}}; };
    };
    stroke(*cutter, notch(0.55), 30);
    stroke(*cutter, notch(0.62), 30);
    stroke(
        *cutter,
        [](double t) {
            return Edge{{0.56, 0.3 + 0.6 * t, 2}, {0.56, 0.3 + 0.6 * t, -1}};
        },
        30);
    const std::vector<Piece> pieces = pieces_of(*cutter);
    const auto largest = std::max_element(pieces.begin(), pieces.end(),
                                          [](const Piece& a, const Piece& b) { return a.volume < b.volume; });

    const Body all = material_body(*cutter);
    Body body = cube;
    body.elements.tets.clear();
    body.material.nodes = all.material.nodes;
    std::map<Index, Index> kept; // element
    for (std::size_t t = 0; t < all.material.tets.size(); ++t) {
        if (piece_of_copy(*cutter)[row(cutter->material.tets[t].copy)] != largest->id) { continue; }
        const Index element = all.element_of[t];
        const auto [at, is_new] = kept.emplace(element, static_cast<Index>(kept.size()));
        if (is_new) { body.elements.tets.push_back(cube.elements.tets[row(element)]); }
        body.material.tets.push_back(all.material.tets[t]);
        body.element_of.push_back(at->second);
    }
    return body;
}

TEST_CASE("a partly filled body keeps its fill, and elements with two parts start with two copies") {
    const Body body = make_partial_body();
    const CutterPtr cutter = cutter_of(body);
    CHECK(find_broken_invariant(*cutter) == "");
    CHECK(pieces_of(*cutter).size() == 1);
    const SimulationMesh& mesh = simulation_mesh(*cutter);
    CHECK(mesh.copy_node.size() > body.elements.tets.size());
    int partial = 0;
    for (const double fraction : mesh.copy_fraction) {
        partial += fraction < 1 - 1e-9 ? 1 : 0;
    }
    CHECK(partial > 20);
    const double mass = mass_of(*cutter);
    double volume = 0;
    for (const Piece& piece : pieces_of(*cutter)) {
        volume += piece.volume;
    }
    CHECK(mass == doctest::Approx(volume).epsilon(1e-12));

    const CutReport report = stroke(*cutter, across_x(0.33), 40);
    stroke(*cutter, across_y(0.4), 40);
    CHECK(report.copies_added > 0);
    CHECK(report.elements_cut < report.copies_added + 1);
    CHECK(find_broken_invariant(*cutter) == "");
    CHECK(pieces_of(*cutter).size() >= 3);
    CHECK(mass_of(*cutter) == doctest::Approx(mass).epsilon(1e-12));
}

TEST_CASE("material that is exported is taken up again as it was") {
    const CutterPtr cutter = cutter_of(make_partial_body());
    stroke(*cutter, across_x(0.33), 40);
    const CutterPtr again = cutter_of(material_body(*cutter));
    CHECK(find_broken_invariant(*again) == "");
    CHECK(simulation_mesh(*again).copy_node.size() == simulation_mesh(*cutter).copy_node.size());
    CHECK(simulation_mesh(*again).node_mass.size() == simulation_mesh(*cutter).node_mass.size());
    const auto volumes = [](Cutter& of) {
        std::vector<double> all;
        for (const Piece& piece : pieces_of(of)) {
            all.push_back(piece.volume);
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    const std::vector<double> before = volumes(*cutter);
    const std::vector<double> after = volumes(*again);
    REQUIRE(before.size() == after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        CHECK(after[i] == doctest::Approx(before[i]).epsilon(1e-12));
    }
}

TEST_CASE("homes lie in the material of their node's copies, at the element node where that is held") {
    const CutterPtr cutter = cutter_of(make_partial_body());
    stroke(*cutter, across_x(0.33), 40);
    const SimulationMesh& mesh = simulation_mesh(*cutter);
    std::vector<double> distance(mesh.node_home.size(), 1e9);
    std::vector<Index> met(mesh.node_home.size(), 0);
    for (std::size_t c = 0; c < mesh.copy_node.size(); ++c) {
        for (Index m = cutter->first_tet[c]; m >= 0; m = cutter->material.tet(m).next) {
            for (const Index node : mesh.copy_node[c]) {
                const Vec3& goal = cutter->body.elements.nodes[row(mesh.node_reference[row(node)])];
                for (std::size_t k = 0; k < 4; ++k) {
                    const Vec3& p = cutter->material.at(cutter->material.tet(m), k);
                    distance[row(node)] = std::min(distance[row(node)], length(p - goal));
                    if (p == mesh.node_home[row(node)]) { met[row(node)] = 1; }
                }
            }
        }
    }
    for (std::size_t n = 0; n < met.size(); ++n) {
        const Vec3& goal = cutter->body.elements.nodes[row(mesh.node_reference[n])];
        CHECK(met[n] == 1);
        if (distance[n] == 0) { CHECK(mesh.node_home[n] == goal); }
    }
}

/// Momentum by nodes whose velocities follow the deltas: new nodes start with their source's.
TEST_CASE("a first cut keeps mass and momentum, and plain copies add what is predicted") {
    for (const Weights weights : {Weights::fraction, Weights::copy}) {
        const CutterPtr cutter = cutter_of(make_cube(5, 0.2, 2), weights);
        const SimulationMesh& mesh = simulation_mesh(*cutter);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> speed(-1, 1);
        std::vector<double> velocity;
        for (std::size_t n = 0; n < mesh.node_mass.size(); ++n) {
            velocity.push_back(speed(random));
        }
        const auto momentum = [&] {
            double sum = 0;
            for (std::size_t n = 0; n < velocity.size(); ++n) {
                sum += mesh.node_mass[n] * velocity[n];
            }
            return sum;
        };
        const double momentum_before = momentum();
        const std::vector<double>& element_mass = cutter->setup.element_mass;

        place_blade(*cutter, 0, across_x(0.45)(0));
        CutReport report;
        double added_mass = 0;
        double added_momentum = 0;
        for (int i = 1; i <= 40; ++i) {
            Delta delta;
            const std::vector<Vec3f> rest(mesh.node_mass.size());
            sweep_blade(*cutter, 0, across_x(0.45)(i / 40.0), rest, rest, delta, report);
            for (const Delta::NewNode& node : delta.nodes) {
                REQUIRE(row(node.node) == velocity.size());
                velocity.push_back(velocity[row(node.source)]);
            }
            for (const Delta::NewCopy& copy : delta.copies) {
                const double mass = element_mass[row(mesh.copy_element[row(copy.copy)])];
                added_mass += mass;
                for (const Index node : mesh.copy_node[row(copy.copy)]) {
                    added_momentum += mass / 4 * velocity[row(node)];
                }
            }
        }
        REQUIRE(report.copies_added > 50);
        const bool whole = weights == Weights::copy;
        CHECK(mass_of(*cutter) == doctest::Approx(1 + (whole ? added_mass : 0)).epsilon(1e-12));
        CHECK(std::abs(momentum() - momentum_before - (whole ? added_momentum : 0)) < 1e-12);
    }
}

TEST_CASE("deltas alone carry a mirror of the mesh along") {
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 9));
    const SimulationMesh& mesh = simulation_mesh(*cutter);
    SimulationMesh mirror = mesh;
    const auto follow = [&](const Delta& delta) {
        for (const Delta::NewCopy& copy : delta.copies) {
            CHECK(row(copy.copy) == mirror.copy_node.size());
            mirror.copy_node.push_back(mirror.copy_node[row(copy.parent)]);
            mirror.copy_element.push_back(mirror.copy_element[row(copy.parent)]);
            mirror.copy_weight.push_back(0);
        }
        for (const Delta::NewNode& node : delta.nodes) {
            CHECK(row(node.node) == mirror.node_mass.size());
            mirror.node_reference.push_back(mirror.node_reference[row(node.source)]);
            mirror.node_mass.push_back(0);
            mirror.node_home.push_back({});
            mirror.node_held.push_back(0);
        }
        for (const auto& [copy, corner, node] : delta.corners) {
            mirror.copy_node.edit(row(copy))[row(corner)] = node;
        }
        for (const Index copy : delta.weighed) {
            mirror.copy_weight.edit(row(copy)) = mesh.copy_weight[row(copy)];
        }
        for (const Index node : delta.touched_nodes) {
            mirror.node_mass.edit(row(node)) = mesh.node_mass[row(node)];
            mirror.node_home.edit(row(node)) = mesh.node_home[row(node)];
        }
    };
    CutReport report;
    for (const Poses& poses : {across_x(0.4), across_y(0.6), across_x(0.6)}) {
        place_blade(*cutter, 0, poses(0));
        for (int i = 1; i <= 25; ++i) {
            Delta delta;
            const std::vector<Vec3f> rest(mesh.node_mass.size());
            sweep_blade(*cutter, 0, poses(i / 25.0), rest, rest, delta, report);
            follow(delta);
        }
    }
    CHECK(report.copies_added > 50);
    CHECK(mirror.copy_node == mesh.copy_node);
    CHECK(mirror.copy_element == mesh.copy_element);
    CHECK(mirror.copy_weight == mesh.copy_weight);
    CHECK(mirror.node_reference == mesh.node_reference);
    CHECK(mirror.node_mass == mesh.node_mass);
    CHECK(mirror.node_home == mesh.node_home);
}

TEST_CASE("only material on the wall is held once it is cut free") {
    const Body body = make_cube(5, 0.1, 1);
    for (const bool by_nodes : {false, true}) {
        CutterSetup setup = make_setup(body);
        HeldRegion wall = {{{-1, -1, -1}, {0, 2, 2}}, {}};
        if (by_nodes) {
            for (const Vec3& p : body.elements.nodes) {
                wall.node_marked.push_back(p[0] <= 0 ? 1 : 0);
            }
        }
        setup.held.push_back(wall);
        const CutterPtr cutter = must(make_cutter(body, setup));
        const SimulationMesh& mesh = simulation_mesh(*cutter);
        CHECK(std::count(mesh.node_held.begin(), mesh.node_held.end(), 1) == 36);
        stroke(*cutter, plane_poses({1, 0, 0}, {0.09, 0.5, 0.5}, {0, 1, 0}), 40);
        const std::vector<Piece> pieces = pieces_of(*cutter);
        REQUIRE(pieces.size() == 2);
        CHECK_FALSE(pieces[0].held); // the larger part kept the id, and left the wall
        CHECK(pieces[1].held);
        CHECK(pieces[1].volume < 0.2);
        CHECK(pieces[0].centre[0] > 0.5);
        CHECK(pieces[0].mass + pieces[1].mass == doctest::Approx(1).epsilon(1e-12));
    }
}

TEST_CASE("the surface is labelled by stroke and side, and encloses what moves with it") {
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 3));
    const std::vector<Vec3f> none(cutter->mesh.node_reference.size());
    const Surface uncut = update_surface(*cutter, none, 0);
    CHECK(uncut.triangle.size() == 6 * 4 * 4 * 2);
    REQUIRE(uncut.dirty.size() == 1);
    const std::uint64_t revision = uncut.revision;
    CHECK(update_surface(*cutter, none, revision).dirty.empty());

    stroke(*cutter, across_x(0.45), 40);
    stroke(*cutter, across_y(0.45), 40);
    const std::vector<Vec3f> twice(cutter->mesh.node_reference.size());
    std::vector<Vec3f> grown = twice;
    for (std::size_t n = 0; n < grown.size(); ++n) {
        grown[n] = to_float(cutter->body.elements.nodes[row(cutter->mesh.node_reference[n])]);
    }
    const Surface cut = update_surface(*cutter, grown, revision);
    CHECK_FALSE(cut.dirty.empty());
    std::array<double, 5> area = {}; // by label + 2
    double volume = 0;
    for (std::size_t i = 0; i < cut.triangle.size(); ++i) {
        const auto& [a, b, c] = cut.triangle[i];
        const Vec3 p = to_double(cut.position[row(a)]);
        const Vec3 q = to_double(cut.position[row(b)]);
        const Vec3 r = to_double(cut.position[row(c)]);
        volume += dot(p, cross(q, r)) / 6;
        area[row(cut.face[i] + 2)] += length(cross(q - p, r - p)) / 2;
    }
    CHECK(volume == doctest::Approx(8).epsilon(1e-5)); // twice as large in each direction
    CHECK(area[2] == doctest::Approx(24).epsilon(1e-5));
    CHECK(area[1] == doctest::Approx(area[3]).epsilon(1e-5));
    CHECK(area[0] == doctest::Approx(area[4]).epsilon(1e-5));
    CHECK(area[3] > 3.5);
    // The sides of the first stroke lie on the two sides of its plane.
    double wrong = 0;
    for (std::size_t i = 0; i < cut.triangle.size(); ++i) {
        if (std::abs(cut.face[i]) != 1) { continue; }
        const auto& [a, b, c] = cut.triangle[i];
        const Vec3 origin = to_double(cut.rest[row(a)]);
        const Vec3 out = cross(to_double(cut.rest[row(b)]) - origin, to_double(cut.rest[row(c)]) - origin);
        const double along = dot(out, Vec3{1, 0.2, 0.1}) * cut.face[i];
        if (along > 0) { wrong += length(out) / 2; }
    }
    CHECK(std::min(wrong, area[1] / 4 * 2 - wrong) < 0.02);
}

TEST_CASE("pieces keep their ids while others come from them") {
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 3));
    CHECK(pieces_of(*cutter)[0].id == 0);
    stroke(*cutter, across_x(0.3), 40);
    const std::vector<Piece> two = pieces_of(*cutter);
    REQUIRE(two.size() == 2);
    CHECK(two[0].volume > 0.6);
    CHECK(two[1].id == 1);
    stroke(*cutter, across_x(0.8), 40);
    const std::vector<Piece> three = pieces_of(*cutter);
    REQUIRE(three.size() == 3);
    CHECK(three[1].id == 1);
    CHECK(three[1].volume == two[1].volume);
    CHECK(three[2].id == 2);
}

TEST_CASE("blades at work at once each cut their own sheet") {
    const CutterPtr cutter = cutter_of(make_cube(5, 0.2, 3));
    const Poses poses[] = {across_x(0.2), across_x(0.8)};
    for (Index b = 0; b < 2; ++b) {
        place_blade(*cutter, b, poses[b](0));
    }
    CutReport report;
    for (int i = 1; i <= 60; ++i) {
        for (Index b = 0; b < 2; ++b) {
            Delta delta;
            const std::vector<Vec3f> rest(cutter->mesh.node_mass.size());
            sweep_blade(*cutter, b, poses[b](i / 60.0), rest, rest, delta, report);
        }
    }
    CHECK(find_broken_invariant(*cutter) == "");
    CHECK(pieces_of(*cutter).size() == 3);
}

TEST_CASE("a blade that appears inside tissue cuts only from there on") {
    const CutterPtr cutter = cutter_of(make_cube(4, 0.2, 3));
    const std::uint64_t before = hash_topology(*cutter);
    place_blade(*cutter, 0, {{0.53, 0.5, 2}, {0.53, 0.5, -1}});
    CHECK(hash_topology(*cutter) == before);
    const CutReport report = sweep(
        *cutter,
        [](double t) {
            return Edge{{0.53, 0.5 + t, 2}, {0.53, 0.5 + t, -1}};
        },
        30);
    CHECK(report.area > 0.3);
    CHECK(report.area < 0.6);
    CHECK(pieces_of(*cutter).size() == 1);
}

/// Not inlined: the compiler takes the pointer inside Result for null otherwise.
[[gnu::noinline]] const std::string& message_of(const Result<CutterPtr>& made) {
    return made.error().message;
}

std::string reason(const Body& body, std::size_t masses) {
    CutterSetup setup;
    setup.element_mass.assign(masses, 1.0);
    const Result<CutterPtr> made = make_cutter(body, setup);
    if (made) { return "none"; }
    return message_of(made);
}

TEST_CASE("material that does not tile its elements is refused with a reason") {
    const Body good = make_cube(2, 0, 0);
    const std::size_t count = good.elements.tets.size();
    CHECK(reason(good, count) == "none");
    CHECK(reason(good, 3).find("3 masses") == 0);
    Body inverted = good;
    std::swap(inverted.elements.tets[5][0], inverted.elements.tets[5][1]);
    CHECK(reason(inverted, count).find("element tet 5 is flat or inverted") == 0);
    Body astray = good;
    astray.material = good.elements;
    astray.element_of.assign(count, 0);
    CHECK(reason(astray, count).find("lies outside element 0") != std::string::npos);
    Body empty = good;
    empty.material = good.elements;
    empty.material.tets.pop_back();
    for (std::size_t t = 0; t + 1 < count; ++t) {
        empty.element_of.push_back(Index(t));
    }
    CHECK(reason(empty, count).find("holds no material") != std::string::npos);
    Body twice = good;
    twice.elements.tets.push_back(good.elements.tets[0]);
    CHECK(reason(twice, count + 1).find("share a face") != std::string::npos);
    Body lost = good;
    lost.elements.nodes[3][1] = std::nan("");
    CHECK(reason(lost, count).find("vertex 3 is not finite") != std::string::npos);
}

} // namespace
} // namespace resect
