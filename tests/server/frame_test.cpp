// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "server/frame.hpp"
#include "server/pacer.hpp"

using namespace resect;

namespace {

std::string read_vector(const std::string& name) {
    std::ifstream file(RESECT_SOURCE_FOLDER "/tests/server/data/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Simulation make_cube(Index cells) {
    return must(Simulation::create(
        {.body = must(make_block({1, 1, 1}, {cells, cells, cells})), .gravity = {}, .threads = 1}));
}

/// A page's tables, from frames alone.
struct Tables {
    std::vector<Vec3f> position = {}, rest = {};
    std::vector<std::array<Index, 3>> triangle = {};
    std::vector<Index> face = {}, piece = {};
    std::size_t bytes = 0;
    std::uint32_t revision = 0;

    template <class T>
    void write(std::vector<T>& rows, std::size_t first, const char* from, std::size_t size) {
        if (size > 0) { std::memcpy(&rows.at(first), from, size); }
    }

    void apply(const std::string& frame) {
        std::uint32_t header[16];
        std::memcpy(header, frame.data(), 64);
        REQUIRE(header[0] == 0x54435352);
        revision = header[9];
        position.resize(header[10]);
        rest.resize(header[10]);
        triangle.resize(header[11]);
        face.resize(header[11]);
        piece.resize(header[11]);
        std::size_t at = 64;
        for (std::uint32_t i = 0; i < header[14]; ++i) {
            std::uint32_t section[4]; // type, first, rows, bytes
            std::memcpy(section, frame.data() + at, 16);
            const char* from = frame.data() + at + 16;
            if (section[0] == 1) { write(position, section[1], from, section[3]); }
            if (section[0] == 3) { write(triangle, section[1], from, section[3]); }
            if (section[0] == 4) { write(face, section[1], from, section[3]); }
            if (section[0] == 5) { write(piece, section[1], from, section[3]); }
            if (section[0] == 6) { write(rest, section[1], from, section[3]); }
            at += 16 + (section[3] + 7) / 8 * 8;
        }
        REQUIRE(at == frame.size());
        bytes = frame.size();
    }
};

template <class T, class U>
bool are_same(const std::vector<T>& a, std::span<const U> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

} // namespace

TEST_CASE("a page that gets only what changed has the surface after every cut, and after an undo") {
    Simulation cube = make_cube(5);
    Tables page;
    std::uint64_t has = 0;
    const auto follow = [&] {
        page.apply(server::build_frame(cube, {}, {.since_revision = has}, has));
        const Surface surface = cube.surface();
        CHECK(are_same(page.position, surface.position));
        CHECK(are_same(page.rest, surface.rest));
        CHECK(are_same(page.triangle, surface.triangle));
        CHECK(are_same(page.face, surface.face));
        CHECK(are_same(page.piece, surface.piece));
        CHECK(page.revision == static_cast<std::uint32_t>(surface.revision));
    };
    follow();
    const std::size_t whole = page.bytes;
    follow();
    CHECK(10 * page.bytes < 8 * whole); // no topology
    for (int i = 0; i < 12; ++i) {
        const double z = 0.15 + 0.06 * i;
        must(cube.cut({{-0.5, -1, z}, {-0.5, 2, z + 0.1}},
                      {{0.3 + 0.1 * i, -1, z}, {0.3 + 0.1 * i, 2, z + 0.1}}));
        follow();
    }
    for (int i = 0; i < 12; ++i) {
        must(cube.apply(Undo{}));
        follow();
    }
    CHECK(page.bytes <= whole);
}

TEST_CASE("stress and elements come where they are asked for") {
    Simulation cube = make_cube(2);
    std::uint64_t has = 0;
    const std::string bare = server::build_frame(cube, {}, {}, has);
    const std::string full = server::build_frame(cube, {}, {.show = {.stress = true, .elements = true}}, has);
    const std::size_t rows = 16 + 4 * cube.surface().position.size() + 16 + 12 * cube.nodes().rest.size() +
                             16 + 16 * cube.copies().node.size();
    CHECK(full.size() >= bare.size() + rows);
    CHECK(full.size() < bare.size() + rows + 24); // padding
}

TEST_CASE("frames and uploads are those of the shared vectors, byte for byte") {
    Simulation cube = make_cube(1);
    std::uint64_t has = 0;
    const std::string frame =
        server::build_frame(cube, {.frame = 7, .message = 12, .scene = 3, .time = 0.5, .step = 400},
                            {.show = {.stress = true, .elements = true}}, has);
    const std::string shared = read_vector("surface_frame.bin");
    if (shared.empty()) { // written once; in git from then on
        std::ofstream(RESECT_SOURCE_FOLDER "/tests/server/data/surface_frame.bin", std::ios::binary) << frame;
    }
    CHECK(frame == shared);
    const Result<server::Upload> upload = server::parse_upload(read_vector("upload.bin"));
    REQUIRE(upload);
    CHECK(upload->name == "häma.msh");
    CHECK(upload->bytes == "$MeshFormat\n");
}

TEST_CASE("a machine that is too slow gets slow motion, and no debt") {
    using namespace std::chrono_literals;
    server::Pacer pacer;
    const double tick = std::chrono::duration<double>(server::Pacer::tick).count();
    for (int i = 0; i < 200; ++i) {
        pacer.note(10, 0.001);
    }
    CHECK(pacer.seconds(1, 0.001) == doctest::Approx(tick)); // ten times real time
    CHECK(pacer.seconds(0.25, 0.001) == doctest::Approx(0.25 * tick));
    CHECK(pacer.real_time_factor(0.001) == doctest::Approx(10));
    // A hundred times as many steps, as after the material has become stiffer: at once.
    CHECK(pacer.seconds(1, 0.00001) == doctest::Approx(0.075 * tick));
    for (int i = 0; i < 200; ++i) {
        pacer.note(1, 0.010); // a tenth of real time
    }
    CHECK(pacer.seconds(1, 0.001) == doctest::Approx(0.075 * tick));
    const server::Clock::time_point start = server::Clock::now();
    CHECK(pacer.next(start) == start);
    CHECK(pacer.next(start + 1ms) == start + server::Pacer::tick);
    CHECK(pacer.next(start + 10s) == start + 10s); // what was missed is not made up for
    CHECK(pacer.next(start + 10s) == start + 10s + server::Pacer::tick);
}
