// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

using namespace resect;

namespace {

bool says(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

} // namespace

TEST_CASE("--version and --help answer") {
    const Outcome version = run_resect("--version");
    CHECK(version.status == 0);
    CHECK(says(version.out, "resect 0."));
    const Outcome help = run_resect("--help");
    CHECK(help.status == 0);
    for (const char* verb : {"run", "mesh", "info", "picture", "bench"}) {
        CHECK(says(help.out, verb));
    }
}

TEST_CASE("what mesh writes, info reads back") {
    const TemporaryFolder folder;
    for (const char* file : {"block.vtu", "block.vtk", "block.msh"}) {
        CAPTURE(file);
        const Outcome made =
            run_resect("mesh block --size 0.2 0.05 0.05 --cells 16 4 4 -o " + folder.file(file));
        CHECK(made.status == 0);
        const Outcome info = run_resect("info " + folder.file(file));
        CHECK(info.status == 0);
        for (const char* fact : {"nodes          425", "tets           1536 in 1 component",
                                 "0.2 x 0.05 x 0.05 m", "volume         0.0005 m^3", "stable step"}) {
            CAPTURE(fact);
            CHECK(says(info.out, fact));
        }
    }
    const Outcome liver = run_resect("mesh liver --elements 6097 -o " + folder.file("liver.obj"));
    CHECK(liver.status == 0);
    CHECK(says(liver.out, "tets           6097"));
    CHECK(says(read_text(folder.file("liver.obj")), "\nf "));
    CHECK(run_resect("mesh block --split bcc --cells 3 3 3 -o " + folder.file("bcc.vtu")).status == 0);
}

TEST_CASE("files that hold no sound mesh are refused in one line that names the fault") {
    const TemporaryFolder folder;
    write_text(folder.file("text.msh"), "hello\n");
    write_text(folder.file("mesh.xyz"), "1 2 3\n");
    write_text(folder.file("flat.vtk"), "# vtk DataFile Version 3.0\nflat\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                                        "POINTS 4 double\n0 0 0 1 0 0 0 1 0 1 1 0\nCELLS 1 5\n4 0 1 2 3\n"
                                        "CELL_TYPES 1\n10\n");
    write_text(folder.file("nan.vtk"), "# vtk DataFile Version 3.0\nnan\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                                       "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 nan\nCELLS 1 5\n4 0 1 2 3\n"
                                       "CELL_TYPES 1\n10\n");
    for (const char* file : {"none.vtu", "text.msh", "mesh.xyz", "flat.vtk", "nan.vtk"}) {
        CAPTURE(file);
        const Outcome outcome = run_resect("info " + folder.file(file));
        CAPTURE(outcome.err);
        CHECK(is_refusal(outcome));
        CHECK(says(outcome.err, file));
    }
}

TEST_CASE("bodies that cannot be made are refused in one line") {
    const TemporaryFolder folder;
    const std::string out = " -o " + folder.file("x.vtu");
    for (const char* words :
         {"mesh kidney", "mesh liver", "mesh liver --elements -4", "mesh liver --spacing 1e-9",
          "mesh liver --elements 500 --spacing 0.01", "mesh liver --elements 500 --refine 9",
          "mesh block --cells 0 1 1", "mesh block --size -1 1 1", "mesh block --cells 1 1"}) {
        CAPTURE(words);
        const Outcome outcome = run_resect(words + out);
        CAPTURE(outcome.err);
        CHECK(is_refusal(outcome));
    }
    CHECK(is_refusal(run_resect("mesh block -o " + folder.file("no/such/folder.vtu"))));
    CHECK(is_refusal(run_resect("mesh block -o " + folder.file("block.stp"))));
}

TEST_CASE("a surface is drawn as a PNG of the size asked for") {
    const TemporaryFolder folder;
    CHECK(run_resect("mesh block --size 0.1 0.1 0.1 --cells 2 2 2 -o " + folder.file("cube.vtp")).status ==
          0);
    const Outcome drawn = run_resect("picture " + folder.file("cube.vtp") + " -o " + folder.file("cube.png") +
                                     " --size 320x200 --view three_quarter");
    CAPTURE(drawn.err);
    CHECK(drawn.status == 0);
    const std::string png = read_text(folder.file("cube.png"));
    REQUIRE(png.size() > 2000);
    CHECK(png.substr(1, 3) == "PNG");
    const auto byte = [&](std::size_t at) {
        return static_cast<unsigned>(static_cast<unsigned char>(png[at]));
    };
    CHECK(byte(18) * 256 + byte(19) == 320);
    CHECK(byte(22) * 256 + byte(23) == 200);
}

TEST_CASE("what cannot be drawn is refused in one line") {
    const TemporaryFolder folder;
    write_text(folder.file("text.vtp"), "hello");
    write_text(folder.file("text.obj"), "v 1 2\n");
    for (const char* file : {"none.obj", "text.vtp", "text.obj"}) {
        CAPTURE(file);
        const Outcome outcome = run_resect("picture " + folder.file(file) + " -o " + folder.file("x.png"));
        CAPTURE(outcome.err);
        CHECK(is_refusal(outcome));
    }
    CHECK(is_refusal(run_resect("picture")));
}

TEST_CASE("bench prints what it measured, and as JSON") {
    const Outcome outcome = run_resect("bench cut --json -");
    CHECK(outcome.status == 0);
    const nlohmann::json report = nlohmann::json::parse(outcome.out, nullptr, false);
    const nlohmann::json& slow = report["cut"]["increments"];
    CHECK(slow["replays_with_the_same_bits"] == true);
    CHECK(slow["copies_added"] > 100);
    CHECK(slow["us_per_copy"]["median"] > 0);
    CHECK(report["cut"]["same_stroke"].size() == 2);
    REQUIRE(report["cut"]["at_once"].size() > 3);
    for (const nlohmann::json& row : report["cut"]["at_once"]) {
        CHECK(row["copies_added"] >= row["elements_cut"]);
        CHECK(row["elements_cut"] > 50);
        CHECK(row["total_us"] > 0);
    }
    CHECK(is_refusal(run_resect("bench speed")));
}

TEST_CASE("lab writes its report, with the files beside it") {
    const TemporaryFolder folder;
    const Outcome outcome = run_resect("lab --quick --out " + folder.file("lab"));
    CAPTURE(outcome.err);
    CHECK(outcome.status == 0);
    const std::string html = read_text(folder.file("lab/index.html"));
    for (const char* title :
         {"Scene 1", "Scene 2", "Scene 3", "The rivals", "Is the cut state right?", "Paper to code"}) {
        CAPTURE(title);
        CHECK(html.find(title) != std::string::npos);
    }
    for (const char* file :
         {"rivals.csv", "figure_4.csv", "liver_frames.csv", "convergence.csv", "steps.csv"}) {
        CAPTURE(file);
        const std::string csv = read_text(folder.file(std::string("lab/") + file));
        CHECK(csv.size() > 200);
        CHECK(csv.find("nan") == std::string::npos);
        CHECK(csv.find("inf") == std::string::npos);
    }
    CHECK(read_text(folder.file("lab/cuts/Along faces.vtp")).size() > 10000);
    CHECK(is_refusal(run_resect("lab --out /proc/lab")));
    CHECK(is_refusal(run_resect("lab --out ''")));
}
