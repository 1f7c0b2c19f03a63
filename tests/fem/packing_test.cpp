// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <doctest/doctest.h>
#include <random>
#include <utility>

#include "body.hpp"
#include "fem/choose_kernels.hpp"
#include "fem/fans.hpp"

using namespace resect;

namespace {

TestBody make_shaken(double viscous_time = 1e-4) {
    TestBody body = make_test_body(kuhn_block({0.1, 0.12, 0.14}, {10, 12, 14}), Material{}, viscous_time);
    std::mt19937 engine(11);
    std::normal_distribution<double> normal(0, 2e-3);
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        body.nodes.displacement[n] = to_float({normal(engine), normal(engine), normal(engine)});
        body.nodes.velocity[n] = to_float({normal(engine), normal(engine), normal(engine)});
    }
    return body;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
        largest = std::max(largest, length(a[n] - b[n]));
    }
    return largest;
}

double largest(const std::vector<Vec3>& a) {
    return largest_difference(a, std::vector<Vec3>(a.size(), Vec3{}));
}

/// Seats copies anew by `change`, which must leave a sound packing and the same forces.
template <class Change>
void check_forces_stay(TestBody& body, Change change) {
    all_forces(body);
    const std::vector<Vec3> before = nodal_forces(body);
    change();
    CHECK(find_packing_fault(body.packing, body.elements).empty());
    all_forces(body);
    CHECK(largest_difference(nodal_forces(body), before) < 1e-6 * largest(before));
}

} // namespace

TEST_CASE("fans cover each tet once, and in few gathers") {
    const TetMesh mesh = kuhn_block({0.1, 0.1, 0.1}, {5, 5, 5});
    std::vector<Vec3f> at;
    for (const Vec3& x : mesh.nodes) {
        at.push_back(to_float(x));
    }
    std::vector<int> covered(mesh.tets.size(), 0);
    Index gathers = 0;
    for (const Fan& fan : cover_with_fans(mesh.tets, at)) {
        gathers += fan.length + (fan.closed ? 2 : 3);
        for (Index j = 0; j < fan.length; ++j) {
            const Index last = fan.closed && j == fan.length - 1 ? 2 : 3 + j;
            const auto x = [&](Index k) { return mesh.nodes[row(fan.node[row(k)])]; };
            CHECK(signed_volume(x(0), x(1), x(2 + j), x(last)) > 0);
            ++covered[row(fan.tet[row(j)])];
        }
    }
    CHECK(std::count(covered.begin(), covered.end(), 1) == Index(covered.size()));
    CHECK(gathers < 1.5 * double(covered.size()));
}

TEST_CASE("a packing seats every copy once, in as many parts as the copies say") {
    const TestBody body = make_shaken();
    CHECK(body.packing.parts.size() == 3); // 10 080 copies
    CHECK(find_packing_fault(body.packing, body.elements).empty());
}

TEST_CASE(
    "nodes of one part, and those that the same parts share, follow one another in the order for packing") {
    TetMesh mesh = kuhn_block({0.1, 0.12, 0.14}, {10, 12, 14});
    const std::vector<Index> order = order_nodes(mesh, std::vector<float>(mesh.tets.size(), 1e-4F));
    REQUIRE(order.size() == mesh.nodes.size());
    std::vector<Index> rank(order.size(), -1);
    std::vector<Vec3> nodes;
    for (const Index node : order) {
        CHECK(std::exchange(rank[row(node)], static_cast<Index>(nodes.size())) == -1);
        nodes.push_back(mesh.nodes[row(node)]);
    }
    mesh.nodes = nodes;
    for (Tet& tet : mesh.tets) {
        for (Index& node : tet) {
            node = rank[row(node)];
        }
    }
    const TestBody body = make_test_body(mesh, Material{}, 1e-4);
    const auto slots_of = [&](std::size_t node) {
        std::vector<Index> slots;
        for (Index s = body.packing.first_slot[node]; s >= 0; s = body.packing.next_slot[row(s)]) {
            slots.push_back(s);
        }
        return slots;
    };
    std::size_t breaks = 0;
    for (std::size_t node = 1; node < nodes.size(); ++node) {
        std::vector<Index> before = slots_of(node - 1);
        for (Index& slot : before) {
            ++slot;
        }
        breaks += slots_of(node) != before ? 1U : 0U;
    }
    CHECK(breaks < 8); // three parts of their own, and what they share
}

TEST_CASE("copies that were seated anew resist as before") {
    TestBody body = make_shaken();
    check_forces_stay(body, [&] {
        std::mt19937 engine(5);
        for (int i = 0; i < 500; ++i) {
            const Index copy = static_cast<Index>(engine() % unsigned(body.elements.count));
            reseat_copy(body.packing, body.elements, body.nodes, copy);
        }
    });
}

TEST_CASE("a copy cut in two resists as one while its halves move together") {
    TestBody body = make_shaken();
    check_forces_stay(body, [&] {
        for (Index parent = 0; parent < 2000; parent += 3) {
            append_copy_of(body.elements, parent);
            const Index copy = body.elements.count - 1;
            set_weight(body.elements, parent, 0.25, body.rest[row(parent)].volume);
            set_weight(body.elements, copy, 0.75, body.rest[row(parent)].volume);
            seat_new_copy(body.packing, body.elements, body.nodes, copy, parent);
            refresh_copy(body.packing, body.elements, parent);
        }
    });
}

TEST_CASE("repacking seats copies that cuts left alone in fans again, and forces stay") {
    TestBody body = make_shaken();
    const auto parts = Index(body.packing.parts.size());
    check_forces_stay(body, [&] {
        std::mt19937 engine(6);
        for (int i = 0; i < 3000; ++i) {
            const Index copy = static_cast<Index>(engine() % unsigned(body.elements.count));
            reseat_copy(body.packing, body.elements, body.nodes, copy);
            if (i > 1500) { repack(body.packing, body.elements, body.nodes, i % parts); }
        }
        for (int i = 0; i < 150; ++i) {
            repack(body.packing, body.elements, body.nodes, i % parts);
        }
    });
    std::size_t lanes_walked = 0;
    for (const Part& part : body.packing.parts) {
        for (const Cell& cell : part.cells) {
            CHECK(16 * cell.moved <= Index(cell.copies.size()));
        }
        for (const FanBlock& block : part.blocks) {
            lanes_walked += row(block.length * fan_lanes);
        }
    }
    CHECK(lanes_walked < 1.5 * double(body.elements.count));
}

TEST_CASE("however often copies are seated anew, a packing does not grow without bound") {
    TestBody body = make_shaken();
    const auto parts = Index(body.packing.parts.size());
    std::mt19937 engine(8);
    std::size_t in_the_middle = 0;
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 6000; ++i) {
            const Index copy = static_cast<Index>(engine() % unsigned(body.elements.count));
            reseat_copy(body.packing, body.elements, body.nodes, copy);
            repack(body.packing, body.elements, body.nodes, i % parts);
        }
        if (round == 11) { in_the_middle = bytes_of(body.packing); }
    }
    CHECK(find_packing_fault(body.packing, body.elements).empty());
    CHECK(double(bytes_of(body.packing)) < 1.03 * double(in_the_middle));
}

TEST_CASE("parts of their own viscous times resist as one body of each time does") {
    TestBody mixed = make_shaken(0);
    for (Index copy = 5000; copy < mixed.elements.count; ++copy) {
        mixed.elements.blocks[row(copy / lanes)].viscous_time[copy % lanes] = 1e-2F;
    }
    mixed.packing = build_packing(mixed.elements, mixed.nodes);
    CHECK_FALSE(mixed.packing.one_viscous_time);
    CHECK(find_packing_fault(mixed.packing, mixed.elements).empty());
    const StepConstants constants{1e-5F, 1, {0, 0, -9.81F}};
    TestBody placed = mixed;
    step(mixed, constants); // leaves positions of the next step
    step(placed, constants);
    place_all_nodes(placed.packing, placed.nodes);
    CHECK(std::memcmp(mixed.packing.position.data(), placed.packing.position.data(), 16) == 0);
    bool same = true;
    for (std::size_t slot = 0; slot < placed.packing.position.size(); ++slot) {
        same = same && std::memcmp(&mixed.packing.position[slot], &placed.packing.position[slot], 12) == 0;
    }
    CHECK(same);
}

TEST_CASE("every instruction set gives the same bits") {
    TestBody first;
    for (const char* name : {"sse2", "avx2", "avx512"}) {
        if (!choose_kernels(name)) {
            MESSAGE(name, " does not run here");
            continue;
        }
        TestBody body = make_shaken();
        for (Index parent = 0; parent < 200; parent += 3) {
            append_copy_of(body.elements, parent);
            seat_new_copy(body.packing, body.elements, body.nodes, body.elements.count - 1, parent);
        }
        for (int i = 0; i < 5; ++i) {
            step(body, {1e-5F, 1, {0, 0, -9.81F}});
        }
        if (first.elements.count == 0) { first = body; }
        CHECK(body.nodes.displacement == first.nodes.displacement);
        CHECK(body.nodes.velocity == first.nodes.velocity);
    }
    choose_kernels({});
}
