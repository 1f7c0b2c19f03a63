// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/outcome.hpp"
#include "io/scene_schema.hpp"
#include "io/scene_text.hpp"

namespace resect {

namespace {

using nlohmann::json;

constexpr const char* least = R"({"tissue": {"mesh": {"block": {"size": [1, 1, 1], "cells": [1, 1, 1]}}}})";

std::string message_of(std::string_view text, const std::vector<std::string>& overrides = {}) {
    return refusal_of(parse_scene(text, "s.json", overrides));
}

SceneDescription parsed(std::string_view text, const std::vector<std::string>& overrides = {}) {
    return value_of(parse_scene(text, "s.json", overrides));
}

/// A scene that holds the first example of every leaf of a schema, with `mesh` reduced to one alternative.
json example_of(const json& schema) {
    if (schema.contains("examples")) { return schema["examples"][0]; }
    if (schema.contains("items")) {
        const int count = schema.value("minItems", 1);
        json items = json::array();
        for (int i = 0; i < count; ++i) {
            items.push_back(example_of(schema["items"]));
        }
        return items;
    }
    json object = json::object();
    for (const auto& [key, property] : schema["properties"].items()) {
        object[key] = example_of(property);
    }
    return object;
}

/// Scenes that between them say every key of the schema.
std::vector<json> example_scenes() {
    json full = example_of(json::parse(scene_schema));
    full["blades"][0]["path"][1]["time"] = 0.5;
    const json mesh = full["tissue"]["mesh"];
    const json fixed = full["tissue"]["fixed"][0];
    full["tissue"]["fixed"] = {{{"box", fixed["box"]}}, {{"node_set", fixed["node_set"]}}};
    std::vector<json> scenes;
    for (const auto& [kind, source] : mesh.items()) {
        json scene = full;
        scene["tissue"]["mesh"] = {{kind, source}};
        json& initial = scene["tissue"]["initial"];
        if (kind == "file") {
            initial.erase("stretch");
        } else {
            initial = {{"stretch", initial["stretch"]}};
        }
        if (kind == "liver" || kind == "kidney") {
            scene["tissue"]["mesh"][kind].erase("spacing");
            scenes.push_back(scene);
            scene["tissue"]["mesh"][kind] = source;
            scene["tissue"]["mesh"][kind].erase("elements");
        }
        scenes.push_back(scene);
    }
    return scenes;
}

json mesh_back(const SceneDescription& scene) {
    if (const auto* file = std::get_if<FileSource>(&scene.mesh)) { return {{"file", file->path}}; }
    if (const auto* block = std::get_if<BlockSource>(&scene.mesh)) {
        return {{"block",
                 {{"size", block->size},
                  {"cells", block->cells},
                  {"split", block->split == Split::bcc ? "bcc" : "six"}}}};
    }
    const auto* kidney = std::get_if<KidneySource>(&scene.mesh);
    const Lattice& lattice = kidney != nullptr ? kidney->lattice : std::get<LiverSource>(scene.mesh).lattice;
    json made = {{"refine", lattice.refine}};
    if (lattice.elements != 0) { made["elements"] = lattice.elements; }
    if (lattice.spacing != 0) { made["spacing"] = lattice.spacing; }
    return {{kidney != nullptr ? "kidney" : "liver", made}};
}

json tissue_back(const SceneDescription& scene) {
    const Setup& setup = scene.scene.setup;
    json tissue = {{"mesh", mesh_back(scene)}, {"damping", setup.damping}};
    for (const Material& m : setup.materials) {
        tissue["materials"].push_back({{"law", "neo_hookean"},
                                       {"young", m.young},
                                       {"poisson", m.poisson},
                                       {"density", m.density},
                                       {"viscous_time", m.viscous_time}});
    }
    for (const Fixed& fixed : setup.fixed) {
        tissue["fixed"].push_back(fixed.node_set.empty()
                                      ? json{{"box", {{"lo", fixed.box.lo}, {"hi", fixed.box.hi}}}}
                                      : json{{"node_set", fixed.node_set}});
    }
    for (const auto& [node, force] : setup.loads) {
        tissue["loads"].push_back({{"node", node}, {"force", force}});
    }
    if (std::holds_alternative<FileSource>(scene.mesh)) {
        tissue["initial"] = {{"displacement", scene.initial_displacement},
                             {"velocity", scene.initial_velocity}};
    } else {
        tissue["initial"] = {{"stretch", scene.initial_stretch}};
    }
    return tissue;
}

constexpr const char* names_of_quantities[] = {"copy", "recompute", "recompute_all"};

/// What was understood, as a scene file again.
json back(const SceneDescription& description) {
    const Scene& scene = description.scene;
    json result = {{"name", scene.name},
                   {"description", scene.description},
                   {"tissue", tissue_back(description)},
                   {"gravity", scene.setup.gravity},
                   {"cut",
                    {{"weights", scene.setup.cut.weights == Weights::copy ? "copy" : "fraction"},
                     {"quantities", names_of_quantities[int(scene.setup.cut.quantities)]},
                     {"front", scene.setup.cut.front == Front::hold ? "hold" : "soft"},
                     {"refine", scene.setup.cut.refine},
                     {"verify", scene.setup.cut.verify}}},
                   {"time_step", scene.setup.time_step},
                   {"allow_unstable_step", scene.setup.allow_unstable_step},
                   {"duration", scene.duration},
                   {"out", {{"every", scene.output_every}}}};
    if (scene.settle) {
        result["settle"] = {{"residual", scene.settling.residual}, {"at_most", scene.settling.at_most}};
    }
    for (const auto& blade : scene.blades) {
        json path = json::array();
        for (const BladeKey& key : blade) {
            path.push_back({{"time", key.time}, {"heel", key.edge.heel}, {"tip", key.edge.tip}});
        }
        result["blades"].push_back({{"path", path}});
    }
    return result;
}

/// Counts the keys that say something about themselves.
int check_documented(const json& schema, const std::string& path) {
    int keys = 0;
    if (schema.contains("items")) { keys += check_documented(schema["items"], path); }
    if (!schema.contains("properties")) { return keys; }
    for (const auto& entry : schema["properties"].items()) {
        const std::string inner = fmt::format("{}.{}", path, entry.key());
        CAPTURE(inner);
        CHECK(entry.value().value("description", "") != "");
        keys += 1 + check_documented(entry.value(), inner);
    }
    return keys;
}

} // namespace

TEST_CASE("every key of the schema reaches the scene, and comes back as it was") {
    const std::vector<json> scenes = example_scenes();
    REQUIRE(scenes.size() == 6);
    for (const json& scene : scenes) {
        CHECK(back(parsed(scene.dump())) == scene);
    }
}

TEST_CASE("every key of the schema says what it means") {
    CHECK(check_documented(json::parse(scene_schema), "scene") > 40);
}

TEST_CASE("the schema's examples differ from its defaults, so that a key that is read from nowhere shows") {
    const json with_defaults = back(parsed(least));
    json full = example_scenes()[0];
    for (const char* key :
         {"name", "description", "gravity", "cut", "time_step", "allow_unstable_step", "duration", "out"}) {
        CHECK(full[key] != with_defaults[key]);
    }
}

TEST_CASE("a scene that says only its mesh has the defaults of the public structs") {
    const SceneDescription scene = parsed(least);
    const Scene plain;
    const Material material;
    CHECK_FALSE(scene.scene.settle);
    CHECK(scene.scene.settling.residual == plain.settling.residual);
    CHECK(scene.scene.settling.at_most == plain.settling.at_most);
    CHECK(scene.scene.duration == plain.duration);
    CHECK(scene.scene.output_every == plain.output_every);
    CHECK(scene.scene.setup.gravity == plain.setup.gravity);
    CHECK(scene.scene.setup.damping == plain.setup.damping);
    CHECK(scene.scene.setup.time_step == plain.setup.time_step);
    CHECK(scene.scene.setup.cut.weights == plain.setup.cut.weights);
    REQUIRE(scene.scene.setup.materials.size() == 1);
    CHECK(scene.scene.setup.materials[0].young == material.young);
    CHECK(scene.scene.setup.materials[0].poisson == material.poisson);
    CHECK(scene.scene.setup.materials[0].density == material.density);
    CHECK(scene.scene.setup.materials[0].viscous_time == automatic);
}

TEST_CASE("settle is off, on with its defaults, or on with its own values") {
    CHECK_FALSE(parsed(least, {"settle=false"}).scene.settle);
    CHECK(parsed(least, {"settle=true"}).scene.settle);
    const SceneDescription partly = parsed(least, {"settle.residual=0.01"});
    CHECK(partly.scene.settle);
    CHECK(partly.scene.settling.residual == 0.01);
    CHECK(partly.scene.settling.at_most == Settle{}.at_most);
}

TEST_CASE("overrides reach nested keys and items, written either way") {
    const SceneDescription scene =
        parsed(least, {"tissue.materials[0].young=1e4", "tissue.materials.0.density=900", "name=two words",
                       "tissue.mesh.block.cells[2]=5", "cut.weights=copy"});
    CHECK(scene.scene.setup.materials[0].young == 1e4);
    CHECK(scene.scene.setup.materials[0].density == 900);
    CHECK(scene.scene.name == "two words");
    CHECK(std::get<BlockSource>(scene.mesh).cells[2] == 5);
    CHECK(scene.scene.setup.cut.weights == Weights::copy);
}

TEST_CASE("an override can bring what the file lacks") {
    CHECK(std::get<LiverSource>(parsed("{}", {"tissue.mesh.liver.elements=500"}).mesh).lattice.elements ==
          500);
}

TEST_CASE("an override that leads nowhere is refused like a key of the file") {
    CHECK(message_of(least, {"tissue.materials[0].yuong=1"}) ==
          "s.json: tissue.materials[0].yuong: unknown; did you mean young?");
    CHECK(message_of(least, {"tissue.materials[1].young=1"}) ==
          "s.json: tissue.materials: an override asks for item '1' of 1; count from 0");
    CHECK(message_of(least, {"tissue.materials[-1].young=1"}).find("item '-1'") != std::string::npos);
    CHECK(message_of(least, {"duration.x=1"}) ==
          "s.json: duration: an override asks for 'x' inside a plain value");
    CHECK(message_of(least, {"duration"}).find("write key=value") != std::string::npos);
    CHECK(message_of(least, {"=3"}).find("write key=value") != std::string::npos);
    CHECK(message_of(least, {"duration=long"}) == "s.json: duration: is \"long\"; give number");
}

TEST_CASE("a key that is unknown is refused with the nearest known one") {
    CHECK(message_of(R"({"tissue": {"mesh": {"file": "a.vtu"}, "materials": [{"yuong": 1}]}})") ==
          "s.json: tissue.materials[0].yuong: unknown; did you mean young?");
    CHECK(message_of(R"({"tisue": {}})") == "s.json: tisue: unknown; did you mean tissue?");
    CHECK(message_of(R"({"tissue": {"mesh": {"file": "a.vtu"}}, "zzzzzzzzzz": 1})")
              .find("unknown; known here:") != std::string::npos);
}

TEST_CASE("a wrong type, range or size is refused with its path and what would be right") {
    const auto with = [&](const char* change) { return message_of(least, {change}); };
    CHECK(with("tissue.materials[0].young=0") ==
          "s.json: tissue.materials[0].young: is 0; it must be above 0");
    CHECK(with("tissue.materials[0].poisson=0.5") ==
          "s.json: tissue.materials[0].poisson: is 0.5; it must be below 0.5");
    CHECK(with("tissue.materials[0].poisson=-1").find("above -1") != std::string::npos);
    CHECK(with("tissue.materials[0].density=-3").find("above 0") != std::string::npos);
    CHECK(with("tissue.materials=[]") == "s.json: tissue.materials: has 0 items; give at least 1");
    CHECK(with("tissue.materials[0].law=hooke").find("choose neo_hookean") != std::string::npos);
    CHECK(with("gravity=[0,1]") == "s.json: gravity: has 2 items; give 3");
    CHECK(with("gravity=[0,1,\"a\"]") == "s.json: gravity[2]: is \"a\"; give number");
    CHECK(with("cut.weights=half") == "s.json: cut.weights: is \"half\"; choose fraction or copy");
    CHECK(with("settle=3") == "s.json: settle: is 3; give boolean or object");
    CHECK(with("tissue.mesh.block.cells=[1,1,1.5]").find("give integer") != std::string::npos);
    CHECK(with("tissue.mesh.block.cells=[1,1,1e12]").find("at most") != std::string::npos);
    CHECK(with("tissue.loads=[{\"node\": 3000000000, \"force\": [0,0,0]}]").find("at most") !=
          std::string::npos);
    CHECK(with("out.every=0").find("above 0") != std::string::npos);
    CHECK(with("duration=1e999").find("give number") != std::string::npos);
    CHECK(message_of("{}") == "s.json: tissue is missing; add it");
    CHECK(message_of("[]") == "s.json: is []; give object");
}

TEST_CASE("a choice is made once") {
    CHECK(message_of(R"({"tissue": {"mesh": {}}})") ==
          "s.json: tissue.mesh: holds none of block, file, kidney and liver; give exactly one");
    CHECK(message_of(least, {"tissue.mesh.file=a.vtu"}).find("holds several") != std::string::npos);
    CHECK(message_of(R"({"tissue": {"mesh": {"liver": {}}}})").find("none of elements and spacing") !=
          std::string::npos);
    CHECK(message_of(least,
                     {"tissue.fixed=[{\"box\": {\"lo\": [0,0,0], \"hi\": [1,1,1]}, \"node_set\": \"a\"}]"})
              .find("holds several") != std::string::npos);
}

TEST_CASE("what a schema cannot say is refused as well") {
    const auto with_path = [&](const std::string& path) {
        return message_of(least, {"blades=[{\"path\": " + path + "}]"});
    };
    CHECK(with_path(R"([{"time": 0, "heel": [0,0,0], "tip": [1,0,0]}])") ==
          "s.json: blades[0].path: has 1 items; give at least 2");
    CHECK(
        with_path(
            R"([{"time": 1, "heel": [0,0,0], "tip": [1,0,0]}, {"time": 1, "heel": [0,0,0], "tip": [1,0,0]}])") ==
        "s.json: blades[0].path[1].time: is 1 after 1; times must increase");
    CHECK(
        with_path(
            R"([{"time": 1, "heel": [1,0,0], "tip": [1,0,0]}, {"time": 2, "heel": [0,0,0], "tip": [1,0,0]}])")
            .find("heel and tip are one point") != std::string::npos);
    CHECK(message_of(least, {"tissue.fixed=[{\"box\": {\"lo\": [0,2,0], \"hi\": [1,1,1]}}]"}) ==
          "s.json: tissue.fixed[0].box: lo 2 lies above hi 1 along y; exchange them");
    CHECK(message_of(least, {"tissue.fixed=[{\"node_set\": \"\"}]"}).find("name a node set") !=
          std::string::npos);
    CHECK(message_of(least, {"tissue.initial.velocity=v"}).find("the mesh is no file") != std::string::npos);
}

TEST_CASE("what is not JSON is refused with line and column") {
    CHECK(message_of("{\n  \"name\": \"a\",,\n}").rfind("s.json:2:15: not JSON: syntax error", 0) == 0);
    CHECK(message_of("").rfind("s.json:1:1: not JSON: ", 0) == 0);
    CHECK(message_of("{\"duration\": 1e999}").rfind("s.json: not JSON: ", 0) == 0);
    CHECK(message_of("{\"name\": \"a\", \"name\": \"b\"}") ==
          "s.json: the key \"name\" stands twice in one object; keep one");
}

TEST_CASE("a scene cut off at any byte is refused") {
    const std::string text = example_scenes()[0].dump(1);
    for (std::size_t length = 0; length < text.size(); ++length) {
        CHECK_FALSE(parse_scene(text.substr(0, length), "s.json"));
    }
}

} // namespace resect
