// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>

#include "bodies.hpp"
#include "temporary_folder.hpp"

using namespace resect;

namespace {

Setup hanging_block() {
    Setup setup = held_block(4);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 2;
    return setup;
}

void sweep_down(Simulation& simulation, double x, double from, double to) {
    must(simulation.apply(MoveBlade{.to = edge_above(x, from)}));
    must(simulation.apply(MoveBlade{.to = edge_above(x, to)}));
    simulation.advance(0.05);
}

std::string read_all(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_all(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

} // namespace

TEST_CASE("undo goes back to where strokes began, one after the other, time included") {
    Simulation simulation = must(Simulation::create(hanging_block()));
    simulation.advance(0.1);
    std::vector<std::uint64_t> hashes;
    std::vector<double> times;
    for (const double x : {0.031, 0.052, 0.075}) {
        hashes.push_back(simulation.hash());
        times.push_back(simulation.time());
        sweep_down(simulation, x, 0.15, 0.02);
        must(simulation.apply(LiftBlade{}));
        simulation.advance(0.02);
    }
    hashes.push_back(simulation.hash());
    times.push_back(simulation.time());
    must(simulation.cut(edge_above(0.06, 0.15), edge_above(0.06, -0.1)));
    CHECK(simulation.pieces().size() > 1);
    while (!hashes.empty()) {
        must(simulation.apply(Undo{}));
        CHECK(simulation.hash() == hashes.back());
        CHECK(simulation.time() == times.back());
        hashes.pop_back();
        times.pop_back();
    }
    CHECK(simulation.pieces().size() == 1);
    CHECK(simulation.surface().revision > 1);
    const Result<void> none = simulation.apply(Undo{});
    REQUIRE(!none);
    CHECK(none.error().message == "undo: there is no stroke to undo");
    CHECK(std::holds_alternative<Undo>(simulation.record().back().command));
}

TEST_CASE("what follows an undo is as if the stroke had not been") {
    const auto run = [](bool detour) {
        Simulation simulation = must(Simulation::create(hanging_block()));
        simulation.advance(0.1);
        if (detour) {
            sweep_down(simulation, 0.04, 0.15, -0.05);
            must(simulation.apply(Undo{}));
        }
        sweep_down(simulation, 0.06, 0.15, 0.01);
        simulation.advance(0.1);
        return simulation.hash();
    };
    CHECK(run(true) == run(false));
}

TEST_CASE(
    "a snapshot brings back its hash, and the same future, also from a file and in another simulation") {
    const TemporaryFolder folder;
    Simulation simulation = must(Simulation::create(hanging_block()));
    simulation.advance(0.05);
    must(simulation.apply(Prescribe{{124}, {{0.01, 0, 0}}}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.047, 0.15)}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.047, 0.03)}));
    simulation.advance(0.05); // the blade stays in the tissue
    const Snapshot kept = simulation.snapshot();
    const std::uint64_t hash = simulation.hash();
    const std::size_t commands = simulation.record().size();
    const auto go_on = [](Simulation& from) {
        must(from.apply(MoveBlade{.to = edge_above(0.05, -0.05)}));
        const StepReport report = from.advance(0.1);
        CHECK(report.cut.copies_added > 0);
        return from.hash();
    };
    const std::uint64_t later = go_on(simulation);
    CHECK(later != hash);

    must(simulation.restore(kept));
    CHECK(simulation.hash() == hash);
    CHECK(simulation.record().size() == commands);
    CHECK(go_on(simulation) == later);

    must(write_snapshot(folder.file("kept.resect"), kept));
    Simulation other = must(Simulation::create(hanging_block()));
    must(other.restore(must(load_snapshot(folder.file("kept.resect")))));
    CHECK(other.hash() == hash);
    CHECK(other.pieces().size() == 1);
    CHECK(go_on(other) == later);
}

TEST_CASE("snapshots that cannot be are refused in one line") {
    const TemporaryFolder folder;
    Simulation simulation = must(Simulation::create(hanging_block()));
    const std::string path = folder.file("s.resect");
    must(write_snapshot(path, simulation.snapshot()));
    const std::string bytes = read_all(path);
    const auto refusal = [&](const std::string& changed) {
        write_all(path, changed);
        const Result<Snapshot> loaded = load_snapshot(path);
        return loaded ? std::string("taken") : loaded.error().message;
    };
    CHECK(refusal(bytes) == "taken");
    CHECK(refusal("").find("not a snapshot") != std::string::npos);
    CHECK(refusal(bytes.substr(0, bytes.size() / 2)).find("damaged or cut off") != std::string::npos);
    CHECK(refusal(bytes.substr(0, 40)).find("snapshot") != std::string::npos);
    std::string flipped = bytes;
    flipped[bytes.size() / 3] = static_cast<char>(flipped[bytes.size() / 3] ^ 4);
    CHECK(refusal(flipped).find("damaged or cut off") != std::string::npos);

    Setup stiffer = hanging_block();
    stiffer.materials[0].young *= 2;
    Simulation other = must(Simulation::create(stiffer));
    const std::uint64_t before = other.hash();
    CHECK(!other.restore(simulation.snapshot()));
    CHECK(!other.restore(Snapshot()));
    CHECK(other.hash() == before);
    CHECK(!load_snapshot(folder.file("nothing.resect")));
}

TEST_CASE("a stroke that is to be completed goes on until the tissue is parted") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    must(simulation.apply(MoveBlade{.to = edge_above(0.047, 0.15)}));
    const Result<void> unmoved = simulation.apply(LiftBlade{.complete = true});
    REQUIRE(!unmoved);
    CHECK(unmoved.error().message.find("has not moved") != std::string::npos);
    must(simulation.apply(MoveBlade{.to = edge_above(0.047, 0.06)}));
    const StepReport half = simulation.advance(0.05);
    CHECK(half.cut.pieces == 1);
    must(simulation.apply(LiftBlade{.complete = true}));
    const StepReport whole = simulation.advance(0);
    CHECK(whole.cut.pieces == 2);
    CHECK(whole.cut.copies_added > 0);
}

TEST_CASE("the three ways to have precomputed quantities give the same motion") {
    const auto run = [](Quantities quantities) {
        Setup setup = hanging_block();
        setup.cut.quantities = quantities;
        Simulation simulation = must(Simulation::create(setup));
        sweep_down(simulation, 0.047, 0.15, -0.05);
        simulation.advance(0.1);
        const Nodes nodes = simulation.nodes();
        return std::vector<Vec3f>(nodes.displacement.begin(), nodes.displacement.end());
    };
    const std::vector<Vec3f> copied = run(Quantities::copy);
    for (const Quantities way : {Quantities::recompute, Quantities::recompute_all}) {
        const std::vector<Vec3f> computed = run(way);
        REQUIRE(computed.size() == copied.size());
        double apart = 0;
        for (std::size_t n = 0; n < copied.size(); ++n) {
            apart = std::max(apart, length(to_double(computed[n]) - to_double(copied[n])));
        }
        CHECK(apart < 1e-5);
    }
}
