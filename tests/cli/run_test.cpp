// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "program.hpp"

using namespace resect;
using Json = nlohmann::json;

namespace {

/// A small block that is cut half way; quick.
const char* const block_scene = R"({
  "name": "Block",
  "tissue": {"mesh": {"block": {"size": [0.08, 0.04, 0.04], "cells": [8, 4, 4]}}, "damping": 5,
             "materials": [{"young": 20000}],
             "fixed": [{"box": {"lo": [0, -1, -1], "hi": [0, 1, 1]}}]},
  "settle": {"residual": 1e-3, "at_most": 20},
  "blades": [{"path": [{"time": 0.01, "heel": [0.03, -0.02, 0.05], "tip": [0.03, 0.06, 0.05]},
                       {"time": 0.11, "heel": [0.031, -0.02, 0.015], "tip": [0.031, 0.06, 0.015]}]}],
  "duration": 0.2
})";

Json run_json(const std::string& words) {
    const Outcome outcome = run_resect("run " + words + " --json -");
    CHECK(outcome.err == "");
    CHECK(outcome.status == 0);
    return Json::parse(outcome.out, nullptr, false);
}

} // namespace

TEST_CASE("a run reports every field of the contract") {
    const TemporaryFolder folder;
    write_text(folder.file("block.json"), block_scene);
    const Json report = run_json(folder.file("block.json"));
    for (const char* field : {"resect_version",
                              "scene",
                              "threads",
                              "isa",
                              "elements",
                              "nodes",
                              "element_copies",
                              "simulation_nodes",
                              "elements_cut",
                              "pieces",
                              "piece_list",
                              "refused",
                              "fixed_nodes",
                              "mass_kg",
                              "mass_initial_kg",
                              "volume_m3",
                              "volume_initial_m3",
                              "opening_m",
                              "time_step_s",
                              "time_step_bound_s",
                              "time_step_live_s",
                              "stretch_min",
                              "stretch_max",
                              "elements_beyond_range",
                              "steps",
                              "simulated_s",
                              "wall_s",
                              "real_time_factor",
                              "element_updates_per_s",
                              "frames",
                              "frame_ms",
                              "step_us",
                              "cut_us",
                              "energies_J",
                              "status",
                              "state_hash"}) {
        CAPTURE(field);
        CHECK(report.contains(field));
    }
    CHECK(report["elements"] == 8 * 4 * 4 * 6);
    CHECK(report["nodes"] == 9 * 5 * 5);
    CHECK(report["fixed_nodes"] == 25);
    CHECK(report["element_copies"] > report["elements"]);
    CHECK(report["elements_cut"] > 20);
    CHECK(report["pieces"] == 1);
    CHECK(report["piece_list"][0]["held"] == true);
    CHECK(report["opening_m"] > 1e-4);
    CHECK(report["frames"] == 12);
    CHECK(report["simulated_s"].get<double>() == doctest::Approx(0.2).epsilon(0.01));
    CHECK(report["time_step_s"] < report["time_step_bound_s"]);
    CHECK(report["mass_kg"].get<double>() == doctest::Approx(0.08 * 0.04 * 0.04 * 1000).epsilon(1e-6));
    CHECK(report["volume_m3"].get<double>() == doctest::Approx(report["volume_initial_m3"].get<double>()));
    for (const char* share : {"p50", "p99", "max"}) {
        CHECK(report["frame_ms"].contains(share));
    }
    CHECK(report["cut_us"]["per_new_copy"] > 0);
    CHECK(report["status"] == "ok");
}

TEST_CASE("the liver is cut through while it moves, and its free part comes away") {
    const Json report = run_json(scene("liver.json") + " --threads 1");
    CHECK(report["elements"] == 6097);
    CHECK(report["elements_cut"] > 200);
    CHECK(report["pieces"] == 2);
    CHECK(report["status"] == "ok");
    CHECK(report["mass_kg"].get<double>() ==
          doctest::Approx(report["mass_initial_kg"].get<double>()).epsilon(1e-6));
    CHECK(report["volume_m3"].get<double>() ==
          doctest::Approx(report["volume_initial_m3"].get<double>()).epsilon(1e-9));
    CHECK(report["elements_inverted"] == 0);
    CHECK(report["refused"] == 0);
    for (const Json& piece : report["piece_list"]) {
        CHECK(piece["volume_m3"] > 2e-4);
        if (!piece["held"]) { CHECK(piece["centre"][2] < -0.3); }
    }
}

TEST_CASE("an incision that stops half way leaves one piece and stays open") {
    const Json report = run_json(scene("liver_incision.json") + " --threads 1");
    CHECK(report["pieces"] == 1);
    CHECK(report["opening_m"] >= 0.005);
    CHECK(report["status"] == "ok");
}

TEST_CASE("the cuboid is cut while it bends, and opens") {
    const Json report = run_json(scene("cuboid.json") + " --threads 1");
    CHECK(report["pieces"] == 1);
    CHECK(report["elements_cut"] > 100);
    CHECK(report["opening_m"] > 0.01);
    CHECK(report["elements_inverted"] == 0);
    CHECK(report["status"] == "ok");
}

TEST_CASE("the hash does not depend on threads, on what is written, or on the time of day") {
    const TemporaryFolder folder;
    write_text(folder.file("block.json"), block_scene);
    std::set<std::string> hashes;
    for (const char* words : {"--threads 1", "--threads 1", "--threads 2", "--threads 3"}) {
        hashes.insert(run_json(folder.file("block.json") + " " + words)["state_hash"]);
    }
    hashes.insert(run_json(folder.file("block.json") + " --out " + folder.file("out"))["state_hash"]);
    CHECK(hashes.size() == 1);
    hashes.insert(run_json(folder.file("block.json") + " --set tissue.damping=6")["state_hash"]);
    CHECK(hashes.size() == 2);
}

TEST_CASE("--seconds and --set change what is run") {
    const TemporaryFolder folder;
    write_text(folder.file("block.json"), block_scene);
    const Json report =
        run_json(folder.file("block.json") +
                 " --seconds 0.05 --set tissue.mesh.block.cells=[4,2,2] --set cut.weights=copy");
    CHECK(report["elements"] == 96);
    CHECK(report["simulated_s"].get<double>() == doctest::Approx(0.05).epsilon(0.05));
}

TEST_CASE("--out holds the series, the surfaces and the report") {
    const TemporaryFolder folder;
    write_text(folder.file("block.json"), block_scene);
    const Outcome outcome = run_resect("run " + folder.file("block.json") + " --set out.every=0.05 --out " +
                                       folder.file("deep/out"));
    CHECK(outcome.status == 0);
    CHECK(outcome.out.find("surface.obj") != std::string::npos);
    for (const char* file :
         {"simulation.pvd", "surface.pvd", "surface.vtp", "surface.obj", "surface_rest.obj", "report.json",
          "simulation_0000.vtu", "simulation_0004.vtu", "surface_0004.vtp"}) {
        CAPTURE(file);
        CHECK(std::filesystem::file_size(folder.file(std::string("deep/out/") + file)) > 100);
    }
    CHECK(Json::parse(read_text(folder.file("deep/out/report.json")), nullptr, false)["status"] == "ok");
    CHECK(read_text(folder.file("deep/out/simulation.pvd")).find("timestep=\"0\"") != std::string::npos);
}

TEST_CASE("a run that diverges or does not settle exits with 1 and still reports and writes") {
    const TemporaryFolder folder;
    write_text(folder.file("block.json"), block_scene);
    const Outcome diverged =
        run_resect("run " + folder.file("block.json") +
                   " --set settle=false --set time_step=0.01 --set allow_unstable_step=true"
                   " --json - --out " +
                   folder.file("out"));
    CHECK(diverged.status == 1);
    CHECK(diverged.err.find("diverged in step") != std::string::npos);
    CHECK(Json::parse(diverged.out, nullptr, false)["status"] == "diverged");
    CHECK(std::filesystem::exists(folder.file("out/surface.obj")));
    CHECK(read_text(folder.file("out/surface.obj")).find("nan") == std::string::npos);

    const Outcome unsettled =
        run_resect("run " + folder.file("block.json") + " --set settle.at_most=0.01 --json -");
    CHECK(unsettled.status == 1);
    CHECK(Json::parse(unsettled.out, nullptr, false)["status"] == "not_settled");
}

TEST_CASE("wrong scenes and command lines are refused in one line, with status 2") {
    const TemporaryFolder folder;
    write_text(folder.file("block.json"), block_scene);
    write_text(folder.file("broken.json"), "{\"name\": \"x\", ");
    write_text(folder.file("empty.json"), "");
    const std::string block = folder.file("block.json");
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"run " + folder.file("none.json"), "none.json"},
        {"run " + folder.file("broken.json"), "broken.json"},
        {"run " + folder.file("empty.json"), "empty.json"},
        {"run " + block + " --set tissue.dampning=3", "damping"},
        {"run " + block + " --set tissue.materials[0].young=-5", "young"},
        {"run " + block + " --set tissue.materials[0].young=1e999", "young"},
        {"run " + block + " --set time_step=1", "allow_unstable_step"},
        {"run " + block + " --set tissue.fixed[0].box.lo=[7,7,7] --set tissue.fixed[0].box.hi=[8,8,8]",
         "fixed"},
        {"run " + block + " --out /proc/nowhere", "/proc/nowhere"},
        {"run " + block + " --seconds -1", "seconds"},
        {"run " + block + " --seconds 1e30", "steps"},
        {"run " + block + " --set time_step=1e-14", "steps"},
        {"run " + block + " --set blades[0].path[0].heel=[0,0,1e9]", "blades[0]"},
        {"run " + block + " --threads 1000000", "threads"},
        {"run " + block + " --json " + folder.file("no/such/folder.json") + " --seconds 0", "folder.json"},
        {"run", "scene"},
        {"walk", "walk"},
        {"", "subcommand"},
        {"run " + block + " --frobnicate", "frobnicate"},
    };
    for (const auto& one : cases) {
        const std::string& words = one.first;
        CAPTURE(words);
        const Outcome outcome = run_resect(words);
        CAPTURE(outcome.err);
        CHECK(is_refusal(outcome));
        CHECK(outcome.err.find(one.second) != std::string::npos);
    }
}

TEST_CASE("a run that is killed leaves a series that can be read, and can be run again") {
    const TemporaryFolder folder;
    const std::string words = fmt::format("run {} --threads 1 --set out.every=0.005 --out {}",
                                          scene("liver.json"), folder.file("out"));
    // Killed as soon as there are frames, wherever the run is by then.
    const int status =
        std::system(fmt::format("{} {} > {} 2>&1 & "
                                "while ! grep -q surface_0002 {} 2> /dev/null; do sleep 0.02; done; "
                                "kill -KILL $!; wait $! 2> /dev/null; true",
                                RESECT_PROGRAM, words, folder.file("log"), folder.file("out/surface.pvd"))
                        .c_str());
    CHECK(status == 0);
    const std::string series = read_text(folder.file("out/surface.pvd"));
    CHECK(series.find("</VTKFile>") != std::string::npos);
    std::size_t named = 0;
    for (std::size_t at = series.find("file=\""); at != std::string::npos;
         at = series.find("file=\"", at + 1)) {
        const std::string file = series.substr(at + 6, series.find('"', at + 6) - at - 6);
        CHECK(read_text(folder.file("out/" + file)).find("</VTKFile>") != std::string::npos);
        ++named;
    }
    CHECK(named > 2);
    const Outcome again =
        run_resect(fmt::format("run {} --seconds 0.01 --out {}", scene("liver.json"), folder.file("out")));
    CHECK(again.status == 0);
}
