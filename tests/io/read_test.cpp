// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <filesystem>
#include <random>
#include <unistd.h>

#include "resect/files.hpp"

#include "base/index.hpp"
#include "io/base64.hpp"
#include "io/file.hpp"
#include "io/number_type.hpp"
#include "io/outcome.hpp"
#include "io/read_mesh_file.hpp"
#include "io/read_msh.hpp"
#include "io/read_vtk.hpp"
#include "io/read_vtu.hpp"
#include "io/refuse.hpp"
#include "io/samples.hpp"
#include "mesh/tet.hpp"

namespace resect {

namespace {

const std::string data_folder = RESECT_SOURCE_FOLDER "/tests/data/";

const std::vector<std::string> good_files = {
    "block_22.msh",       "block_41.msh",        "hand_22.msh",        "hand_41.msh",
    "block_42_ascii.vtk", "block_42_binary.vtk", "block_51_ascii.vtk", "block_51_binary.vtk",
    "block_ascii.vtu",    "block_binary.vtu",    "block_raw_big.vtu",  "block_base64.vtu"};

Body read(const std::string& name) { return value_of(read_mesh_file(data_folder + name)); }

Result<Body> read_bytes(std::string_view bytes, const std::string& name) {
    return read_or_refuse([&] {
        const std::string ending = ending_of(name);
        return ending == ".msh"   ? read_msh(bytes, name)
               : ending == ".vtk" ? read_vtk(bytes, name)
                                  : read_vtu(bytes, name);
    });
}

/// Where the reader took the bytes: whether the mesh holds what a mesh must.
bool is_sound(const Body& body) {
    const auto in_range = [&](Index node) { return 0 <= node && row(node) < body.elements.nodes.size(); };
    bool sound = !body.elements.tets.empty();
    for (const Vec3& node : body.elements.nodes) {
        sound = sound && is_finite(node);
    }
    for (const auto& tet : body.elements.tets) {
        sound = sound && std::all_of(tet.begin(), tet.end(), in_range);
    }
    for (const auto& [name, nodes] : body.node_sets) {
        sound = sound && std::all_of(nodes.begin(), nodes.end(), in_range);
    }
    return sound;
}

/// What a hostile file may bring about: a sound mesh, or one line that names the file.
void check_refused_or_sound(std::string_view bytes, const std::string& name, int& refused) {
    const Result<Body> body = read_bytes(bytes, name);
    if (body) {
        CHECK(is_sound(*body));
        return;
    }
    ++refused;
    const std::string message = refusal_of(body);
    CHECK(message.starts_with(name + ":"));
    CHECK(message.size() < 400);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), with);
}

} // namespace

TEST_CASE("every format gives the same block of twelve tets") {
    const Body first = read("block_22.msh");
    REQUIRE(first.elements.nodes.size() == 12);
    REQUIRE(first.elements.tets.size() == 12);
    double volume = 0;
    for (const auto& tet : first.elements.tets) {
        CHECK(signed_volume(first.elements, tet) > 0);
        volume += signed_volume(first.elements, tet);
    }
    CHECK(volume == doctest::Approx(0.002).epsilon(1e-12));
    for (const std::string& name : good_files) {
        if (!name.starts_with("block")) { continue; }
        INFO(name);
        const Body body = read(name);
        CHECK(body.elements.tets == first.elements.tets);
        REQUIRE(body.elements.nodes.size() == 12);
        const double most = name == "block_raw_big.vtu" || name == "block_base64.vtu" ? 1e-8 : 0; // Float32
        for (std::size_t node = 0; node < 12; ++node) {
            CHECK(length(body.elements.nodes[node] - first.elements.nodes[node]) <= most);
        }
    }
}

TEST_CASE("cells that are no tets are left out with a note") {
    CHECK(read("block_ascii.vtu").notes ==
          std::vector<std::string>{"2 cells that are no linear tetrahedra are left out"});
    CHECK(read("block_raw_big.vtu").notes.empty());
}

TEST_CASE("physical groups of points, curves and surfaces are node sets") {
    using Sets = std::map<std::string, std::vector<Index>>;
    CHECK(read("block_22.msh").node_sets == Sets{{"left side", {0, 3, 6, 9}}});
    CHECK(read("hand_22.msh").node_sets == Sets{{"edge", {0, 1, 2}}, {"points 8", {4}}});
    CHECK(read("hand_41.msh").node_sets ==
          Sets{{"surface 6", {1, 2, 3}}, {"the floor", {1, 2, 3}}, {"tip", {0}}});
}

TEST_CASE("tags of nodes need no order, and positions may carry parameters") {
    const Body four = read("hand_41.msh");
    CHECK(four.elements.nodes == std::vector<Vec3>{{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}});
    CHECK(four.elements.tets == std::vector<std::array<Index, 4>>{{1, 2, 3, 0}, {1, 3, 2, 4}});
    const Body two = read("hand_22.msh");
    CHECK(two.elements.tets == std::vector<std::array<Index, 4>>{{0, 1, 2, 3}, {0, 2, 1, 4}});
    CHECK(two.elements.nodes[2] == Vec3{0, 1, 0});
}

TEST_CASE("one-byte point arrays of a .vtu are node sets, and vectors are read by name") {
    for (const char* name : {"block_ascii.vtu", "block_binary.vtu"}) {
        CHECK(read(name).node_sets.at("left") == std::vector<Index>{0, 3, 6, 9});
        const std::vector<Vec3> velocity = value_of(read_vtu_vectors(data_folder + name, "velocity"));
        REQUIRE(velocity.size() == 12);
        // meshio writes twelve digits into ASCII files.
        CHECK(length(velocity[11] - Vec3{33.0 / 7, 34.0 / 7, 35.0 / 7}) < 1e-11);
    }
    const std::string file = data_folder + "block_ascii.vtu";
    CHECK(refusal_of(read_vtu_vectors(file, "speed")).find("has no point array 'speed'") !=
          std::string::npos);
    CHECK(refusal_of(read_vtu_vectors(file, "left")).find("three components") != std::string::npos);
    CHECK(refusal_of(read_vtu_vectors(data_folder + "block_22.msh", "velocity")).find(".vtu") !=
          std::string::npos);
}

TEST_CASE("what is written is read back bit by bit") {
    const std::string folder =
        std::filesystem::temp_directory_path() / ("resect_read_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const Body body = sample_body();
    for (const char* ending : {".vtu", ".vtk", ".msh"}) {
        INFO(ending);
        const std::string path = folder + "/body" + ending;
        CHECK(static_cast<bool>(write_body(path, body)));
        const Body again = value_of(read_mesh_file(path));
        CHECK(again.elements.nodes == body.elements.nodes);
        CHECK(again.elements.tets == body.elements.tets);
        if (ending != std::string_view(".vtk")) { CHECK(again.node_sets == body.node_sets); }
    }
    std::filesystem::remove_all(folder);
}

TEST_CASE("a file cut off at any byte is refused, or is whole without its tail") {
    for (const std::string& name : good_files) {
        const std::string bytes = read_file(data_folder + name);
        int refused = 0;
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            check_refused_or_sound(std::string_view(bytes).substr(0, size), name, refused);
        }
        CHECK(refused > 100);
    }
}

TEST_CASE("flipped bytes bring a refusal or a sound mesh") {
    std::mt19937 random(7);
    int refused = 0;
    for (const std::string& name : good_files) {
        const std::string bytes = read_file(data_folder + name);
        for (int round = 0; round < 400; ++round) {
            std::string changed = bytes;
            const std::uint32_t flips = 1 + random() % 4;
            for (std::uint32_t flip = 0; flip < flips; ++flip) {
                changed[random() % changed.size()] = static_cast<char>(random() % 256);
            }
            check_refused_or_sound(changed, name, refused);
        }
    }
    CHECK(refused > 1000);
}

TEST_CASE("digits exchanged for others bring a refusal or a sound mesh") {
    std::mt19937 random(8);
    int refused = 0;
    for (const std::string& name : good_files) {
        const std::string bytes = read_file(data_folder + name);
        for (int round = 0; round < 400; ++round) {
            std::string changed = bytes;
            std::size_t at = random() % changed.size();
            while (at < changed.size() && (changed[at] < '0' || changed[at] > '9')) {
                ++at;
            }
            const char* const swaps[] = {
                "-1", "999999999999", "4294967296", "9223372036854775807", "nan", "1e400", ""};
            if (at < changed.size()) { changed.replace(at, 1, swaps[random() % 7]); }
            check_refused_or_sound(changed, name, refused);
        }
    }
    CHECK(refused > 1000);
}

TEST_CASE("a fault in a text file is named with its line") {
    const std::string text = read_file(data_folder + "hand_22.msh");
    const auto message = [&](const char* what, const char* with) {
        return refusal_of(read_bytes(replaced(text, what, with), "a.msh"));
    };
    CHECK(message("1.0e0", "nan") == "a.msh:14: a coordinate is nan; it must be finite");
    CHECK(message("1.0e0", "1,0") == "a.msh:14: '1,0' is no number for a coordinate; mend it");
    CHECK(message("7 1 3 4\n", "7 1 3 5\n") ==
          "a.msh:24: an element uses node 5, which is not in $Nodes; mend it");
    CHECK(message("\n9 0 0 -1", "\n7 0 0 -1").find("a.msh:17: node 7 is there twice") == 0);
    CHECK(message("2.2 0 8", "2.2 1 8").find("a.msh:2: is binary; export it as ASCII") == 0);
    CHECK(message("2.2 0 8", "4.0 0 8").find("a.msh:2: only the versions 2.2 and 4.1 are read") == 0);
    CHECK(message("$Nodes\n5", "$Nodes\n5000000").find("a.msh:12: the number of nodes is 5000000, but") == 0);
    CHECK(message("$Nodes\n5", "$Nodes\n6").find("a.msh:18: '$EndNodes' is no whole number") == 0);
}

TEST_CASE("files that hold no linear tets, or are something else, are refused with a way out") {
    CHECK(refusal_of(read_mesh_file(data_folder + "block_zlib.vtu")).find("write it without compression") !=
          std::string::npos);
    CHECK(refusal_of(read_mesh_file("a.stl")).find(".msh, .vtk and .vtu") != std::string::npos);
    CHECK(refusal_of(read_mesh_file("none.vtu")).find("none.vtu: cannot be read") == 0);
    CHECK(refusal_of(read_bytes("solid a", "a.msh")).find("does not begin with $MeshFormat") !=
          std::string::npos);
    CHECK(refusal_of(read_bytes("solid a", "a.vtk")).find("does not begin as a VTK legacy file") !=
          std::string::npos);
    CHECK(refusal_of(read_bytes("solid a", "a.vtu")).find("a.vtu:1: not XML") == 0);
    CHECK(refusal_of(read_bytes("<VTKFile type=\"PolyData\"/>", "a.vtu")) ==
          "a.vtu: is no UnstructuredGrid but PolyData; write the tetrahedra as one");
    const std::string quadratic =
        replaced(read_file(data_folder + "hand_22.msh"), "5 4 0 7 3 1 9", "5 11 0 7 3 1 9");
    CHECK(refusal_of(read_bytes(replaced(quadratic, "4 4 2 1 1 7 1 3 4", "4 11 2 1 1 7 1 3 4"), "a.msh"))
              .find("holds no linear tetrahedra, but 6 other cells") != std::string::npos);
}

TEST_CASE("numbers of every type are decoded in both byte orders") {
    const std::string one("\x00\x00\x00\x01", 4);
    const std::string minus("\xFF\xFE", 2);
    CHECK(decode_integers(one, *find_number_type("UInt32"), true) == std::vector<std::int64_t>{1});
    CHECK(decode_integers(one, *find_number_type("Int32"), false) == std::vector<std::int64_t>{1 << 24});
    CHECK(decode_integers(minus, *find_number_type("Int16"), true) == std::vector<std::int64_t>{-2});
    CHECK(decode_integers(minus, *find_number_type("UInt16"), true) == std::vector<std::int64_t>{65534});
    CHECK(decode_reals(minus, *find_number_type("Int8"), true) == std::vector<double>{-1, -2});
    CHECK(decode_reals(std::string("\x3F\x80\x00\x00\x00", 5), *find_number_type("Float32"), true) ==
          std::vector<double>{1});
    CHECK_FALSE(find_number_type("String"));
}

TEST_CASE("base64 is decoded with padding at the end and between") {
    CHECK(*decode_base64("QUJD", 3) == "ABC");
    CHECK(*decode_base64("QQ==\nQkM=", 9) == "ABC");
    CHECK(*decode_base64("QUJDREVG", 2) == "ABC");
    CHECK_FALSE(decode_base64("QU*D", 3));
}

} // namespace resect
