// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "lab/methods.hpp"
#include "lab/reference.hpp"
#include "lab/report.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/tet.hpp"
#include "temporary_folder.hpp"

using namespace resect;
using namespace lab;

namespace {

constexpr Vec3 cube = {0.1, 0.1, 0.1};

std::string read(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

TEST_CASE("a sheet is crossed where it is, and its distance is that of its nearest point") {
    const Sheet sheet = flat_notch({0.05, 0, 0.1}, {0.05, 0, 0.04}, 0.1);
    CHECK(sheet.crosses({0.04, 0.05, 0.08}, {0.06, 0.05, 0.07}));
    CHECK_FALSE(sheet.crosses({0.04, 0.05, 0.03}, {0.06, 0.05, 0.03})); // below the tip
    CHECK_FALSE(sheet.crosses({0.06, 0.05, 0.08}, {0.08, 0.05, 0.08}));
    CHECK(sheet.distance({0.07, 0.05, 0.08}) == doctest::Approx(0.02));
    CHECK(sheet.distance({0.05, 0.05, 0.01}) == doctest::Approx(0.03));
}

TEST_CASE("removal takes away what the sheet crosses, faces nothing") {
    const TetMesh mesh = make_jittered_block(cube, {5, 5, 5}, 0.2, 1);
    const Sheet sheet = flat_notch({0.05, 0, 0.1}, {0.05, 0, 0.04}, 0.1);
    double crossed = 0;
    for (const Index tet : find_crossed(mesh, sheet)) {
        crossed += signed_volume(mesh, mesh.tets[row(tet)]);
    }
    CHECK(crossed > 0.05 * volume_of(mesh));
    CHECK(volume_of(remove_elements(mesh, sheet).mesh) == doctest::Approx(volume_of(mesh) - crossed));
    const CutMesh split = split_faces(mesh, sheet);
    CHECK(split.mesh.tets.size() == mesh.tets.size());
    CHECK(volume_of(split.mesh) == doctest::Approx(volume_of(mesh)));
    CHECK(split.mesh.nodes.size() > mesh.nodes.size());
}

TEST_CASE("faces that lie on the sheet are all that is split") {
    const TetMesh mesh = make_jittered_block(cube, {4, 4, 4}, 0, 1);
    const CutMesh through = split_faces(mesh, flat_notch({0.05, 0, 0.2}, {0.05, 0, -0.1}, 0.1));
    CHECK(through.mesh.nodes.size() == mesh.nodes.size() + 25);
    CHECK(build_components(build_face_mates(through.mesh)).sizes.size() == 2);
    const CutMesh half = split_faces(mesh, flat_notch({0.05, 0, 0.1}, {0.05, 0, 0.05}, 0.1));
    CHECK(half.mesh.nodes.size() == mesh.nodes.size() + 10); // two rows above the tip's
    CHECK(build_components(build_face_mates(half.mesh)).sizes.size() == 1);
    const CutSurface surface = surface_of(half, mesh, std::vector<Vec3>(half.mesh.nodes.size()));
    CHECK(measure_roughness(surface, flat_notch({0.05, 0, 0.1}, {0.05, 0, 0.05}, 0.1)) < 1e-12);
}

TEST_CASE("a notch that leans by its depth lies on faces, too") {
    const Notch notch = {.depth = 0.025, .lean = 0.025, .jitter = 0};
    const Problem problem = hang_block({4, 4, 4}, notch);
    const CutMesh split = split_faces(problem.mesh, problem.sheet);
    CHECK(split.mesh.nodes.size() == problem.mesh.nodes.size() + 5); // the row at the mouth
    const CutSurface surface = surface_of(split, problem.mesh, std::vector<Vec3>(split.mesh.nodes.size()));
    CHECK(measure_roughness(surface, problem.sheet) < 1e-12);
}

TEST_CASE("snapped nodes lie on the sheet and leave sound tets") {
    const TetMesh mesh = make_jittered_block(cube, {5, 5, 5}, 0.2, 1);
    const Sheet sheet = flat_notch({0.062, 0, 0.2}, {0.06, 0, -0.1}, 0.1);
    const auto count = [&](const TetMesh& of) {
        return std::count_if(of.nodes.begin(), of.nodes.end(),
                             [&](const Vec3& node) { return sheet.distance(node) < 1e-9; });
    };
    const TetMesh snapped = snap_nodes(mesh, sheet, 0.005, {{0, 0, 0}, cube});
    CHECK(count(mesh) == 0);
    CHECK(count(snapped) >= 10);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        CHECK(signed_volume(snapped, snapped.tets[t]) > 0);
    }
    CHECK(volume_of(snapped) == doctest::Approx(volume_of(mesh)));
}

TEST_CASE("a gauge reads what a stretch does to it") {
    const CutMesh block = drop_unused_nodes(make_jittered_block(cube, {3, 3, 3}, 0.2, 1));
    std::vector<Vec3> stretched;
    for (const Vec3& node : block.mesh.nodes) {
        stretched.push_back({0.25 * node[0], 0, 0});
    }
    const CutSurface surface = surface_of(block, block.mesh, stretched);
    CHECK(measure_gauge(surface, {0.03, 0.05, 0.1}, {0.07, 0.05, 0.1}) == doctest::Approx(0.01));
}

TEST_CASE("what the report says of the methods is so on a coarse block") {
    const Problem problem = hang_block({5, 4, 5});
    const Outcome ours = cut_by_virtual_nodes(problem);
    CHECK(std::abs(ours.volume_lost) < 1e-12);
    CHECK(std::abs(ours.mass_error) < 1e-6);
    CHECK(ours.roughness < 0.05 * problem.spacing);
    const Outcome copies = cut_by_virtual_nodes(problem, {.weights = Weights::copy});
    CHECK(copies.mass_error > 0.02);
    const Outcome removal = cut_by_removal(problem);
    CHECK(removal.volume_lost > 0.03);
    CHECK(removal.roughness > 0.3 * problem.spacing);
    const Outcome subdivision = cut_by_subdivision(problem, false);
    CHECK(subdivision.step < 0.5 * ours.step);
    CHECK(subdivision.roughness == doctest::Approx(ours.roughness).epsilon(1e-3));
    for (const Outcome& one :
         {ours, copies, removal, cut_along_faces(problem, true), cut_along_faces_linear(problem),
          cut_by_woodbury(problem), cut_by_tensor_mass(problem)}) {
        CAPTURE(one.method);
        REQUIRE(one.opening);
        CHECK(*one.opening > 0.001);
        CHECK(*one.opening < 0.03);
    }
    // The two linear ways through the same mesh agree, but for tets that one of them has to keep.
    CHECK(*cut_by_tensor_mass(problem).opening ==
          doctest::Approx(*cut_by_woodbury(problem).opening).epsilon(0.05));
}

TEST_CASE("CalculiX gives the openings that are stored") {
    const TemporaryFolder folder;
    int checked = 0;
    for (const StoredReference& one : list_references()) {
        if (one.quadratic || one.problem.mesh.tets.size() > 300) { continue; }
        CAPTURE(one.name);
        const std::optional<double> opening =
            find_reference_opening(one.problem, one.quadratic, folder.file("calculix"));
        REQUIRE_MESSAGE(opening, "CalculiX (ccx) did not run; ./test installs it");
        CHECK(*opening == doctest::Approx(one.stored).epsilon(1e-4));
        ++checked;
    }
    CHECK(checked == 3);
}

TEST_CASE("a report is one page with its findings inside, and files beside it") {
    const TemporaryFolder folder;
    const std::string page = folder.file("page.html");
    std::ofstream(page) << "<html><!-- report --></html>";
    const CutMesh block = drop_unused_nodes(make_jittered_block(cube, {2, 2, 2}, 0, 1));
    const Report report = {
        .title = "A </script> in a title",
        .sections = {
            {.title = "one",
             .parts = {
                 Plot{.name = "line", .x_label = "x, m", .y_label = "y", .series = {{"a", {1, 2}, {3, 4}}}},
                 Table{.name = "list", .columns = {"a", "b"}, .rows = {{"1,5", "say \"x\""}}},
                 Strip{.name = "strip",
                       .stills = {{"still", surface_of(block, block.mesh, std::vector<Vec3>(27))}}}}}}};
    must(write_report(folder.file("out"), report, page));
    CHECK(read(folder.file("out/line.csv")) == "series,\"x, m\",y\na,1,3\na,2,4\n");
    CHECK(read(folder.file("out/list.csv")) == "a,b\n\"1,5\",\"say \"\"x\"\"\"\n");
    CHECK(std::filesystem::file_size(folder.file("out/strip/still.vtp")) > 1000);
    const std::string html = read(folder.file("out/index.html"));
    const std::size_t begin = html.find('{');
    const std::size_t end = html.find("</script>");
    const nlohmann::json found = nlohmann::json::parse(html.substr(begin, end - begin));
    CHECK(found["title"] == "A </script> in a title");
    CHECK(found["sections"][0]["parts"].size() == 3);
    CHECK(found["sections"][0]["parts"][2]["surfaces"][0]["base64"].get<std::string>().size() > 1000);
    CHECK(write_report(folder.file("out"), report, folder.file("none.html"))
              .error()
              .message.find("none.html") != std::string::npos);
}
