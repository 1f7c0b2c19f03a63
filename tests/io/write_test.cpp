// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <unistd.h>

#include "resect/files.hpp"

#include "io/file.hpp"
#include "io/outcome.hpp"
#include "io/refuse.hpp"
#include "io/samples.hpp"

namespace resect {

namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone at the end.
struct Folder {
    std::string path = fs::temp_directory_path() / ("resect_write_test_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }
    std::string operator/(const char* name) const { return path + "/" + name; }
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(path)) {
            names.push_back(entry.path().filename());
        }
        return names;
    }
};

std::string content_of(const std::string& path) {
    return value_of(read_or_refuse([&] { return read_file(path); }));
}

void check_written(const Result<void>& result) {
    CHECK_MESSAGE(result, (result ? "" : result.error().message));
}

} // namespace

TEST_CASE("a file is written whole and leaves nothing beside it") {
    const Folder folder;
    check_written(write_file(folder / "a", "first"));
    check_written(write_file(folder / "a", "second"));
    CHECK(content_of(folder / "a") == "second");
    CHECK(folder.names() == std::vector<std::string>{"a"});
}

TEST_CASE("a link is followed, not replaced") {
    const Folder folder;
    check_written(write_file(folder / "a", "first"));
    fs::create_symlink("a", folder / "link");
    check_written(write_file(folder / "link", "second"));
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(content_of(folder / "a") == "second");
}

TEST_CASE("a device is written to, not replaced") {
    check_written(write_file("/dev/null", "gone"));
    CHECK_FALSE(fs::is_regular_file("/dev/null"));
    CHECK(refusal_of(write_file("/dev/full", std::string(100000, 'x'))).find("free some space") !=
          std::string::npos);
}

TEST_CASE("what cannot be written or read is refused in one line that names it") {
    const Folder folder;
    CHECK(refusal_of(write_file(folder / "none/a", "x")).find("its folder does not exist") !=
          std::string::npos);
    CHECK(refusal_of(write_file(folder.path, "x")) == folder.path + ": is a folder; name a file in it");
    CHECK(refusal_of(read_or_refuse([&] { return read_file(folder.path); })) ==
          folder.path + ": is a folder; name a file in it");
    CHECK(refusal_of(read_or_refuse([&] { return read_file(folder / "none"); })).find("check the path") !=
          std::string::npos);
    CHECK(folder.names().empty());
}

TEST_CASE("an ending that is not ours is refused with those that are") {
    CHECK(refusal_of(write_surface("a.fbx", {})).find(".obj, .stl, .ply or .vtp") != std::string::npos);
    CHECK(refusal_of(write_body("a", {})).find(".vtu, .vtk or .msh") != std::string::npos);
    CHECK(refusal_of(write_series("a.vtu", {})).find(".pvd") != std::string::npos);
    CHECK(ending_of("a.b/c.VTU") == ".vtu");
}

TEST_CASE("OBJ holds one point for each material vertex, normals of corners, and the shortest digits") {
    const Folder folder;
    check_written(write_surface(folder / "a.obj", SampleSurface().view()));
    CHECK(content_of(folder / "a.obj") ==
          "v 0.1 0 1e-20\nv 0.33333334 0 0\nv 0 -3333333200 0\nv 0 0 5592405.5\n"
          "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn 0.6 0.8 0\nvn 0 -0.6 0.8\n"
          "f 1//1 3//3 2//2\nf 1//1 2//2 4//4\nf 1//1 4//4 3//3\nf 2//2 3//3 4//5\n");
    check_written(write_rest_surface(folder / "rest.obj", SampleSurface().view()));
    CHECK(content_of(folder / "rest.obj") == "v 0 0 0\nv 0.7 0 0\nv 0 0.7 0\nv 0 0 0.7\n"
                                             "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
}

TEST_CASE("a PLY has normals as long as every point has one") {
    const Folder folder;
    const auto has = [&](const char* words) {
        return content_of(folder / "a.ply").find(words) != std::string::npos;
    };
    check_written(write_surface(folder / "a.ply", SampleSurface().split()));
    CHECK(has("element vertex 5\n"));
    CHECK(has("property float nx\n"));
    check_written(write_surface(folder / "a.ply", SampleSurface().view()));
    CHECK(has("element vertex 4\n"));
    CHECK_FALSE(has("property float nx\n"));
}

TEST_CASE("STL holds a normal and three corners a triangle") {
    const Folder folder;
    SampleSurface surface;
    check_written(write_rest_surface(folder / "a.stl", surface.view()));
    const std::string bytes = content_of(folder / "a.stl");
    REQUIRE(bytes.size() == 84 + 4 * 50);
    std::uint32_t count = 0;
    std::memcpy(&count, &bytes[80], 4);
    CHECK(count == 4);
    Vec3f normal = {}, corner = {};
    std::memcpy(&normal, &bytes[84], 12);
    std::memcpy(&corner, &bytes[84 + 12 + 12], 12);
    CHECK(normal == Vec3f{0, 0, -1});
    CHECK(corner == surface.rest[2]);
}

TEST_CASE("a surface without triangles is written, too") {
    const Folder folder;
    for (const char* name : {"a.obj", "a.stl", "a.ply", "a.vtp"}) {
        check_written(write_surface(folder / name, {}));
    }
    CHECK(folder.names().size() == 4);
}

} // namespace resect
