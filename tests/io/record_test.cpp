// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <fstream>

#include "resect/resect.hpp"

#include "io/outcome.hpp"
#include "temporary_folder.hpp"

using namespace resect;

namespace {

std::string refusal(const std::string& text) { return refusal_of(parse_command(text)); }

std::string refused_file(const TemporaryFolder& folder, const std::string& text) {
    const std::string path = folder.file("r.json");
    std::ofstream(path) << text;
    const std::string message = refusal_of(load_record(path));
    REQUIRE(message.starts_with(path + ": "));
    return message.substr(path.size() + 2);
}

const std::vector<Command>& commands() {
    static const std::vector<Command> all = {MoveBlade{2, {{0.1, 1.0 / 3, -1e-9}, {0, 0, 1e300}}},
                                             LiftBlade{1, true},
                                             Prescribe{{0, 7}, {{0.1, 0, 0}, {0, 0.2, 0}}},
                                             Prescribe{{3}, {}},
                                             SetGravity{{0, 0, -9.81}},
                                             Undo{},
                                             Grasp{4, {0.1, 0.2, 0.3}, 0.01},
                                             MoveGrasp{4, {0.2, 0.2, 0.3}},
                                             Release{4},
                                             SetMaterial{0, {.young = 1e4, .poisson = 0.3}}};
    return all;
}

} // namespace

TEST_CASE("every command comes back from its text, to the last bit") {
    for (const Command& command : commands()) {
        const std::string text = format_command(command);
        CHECK(format_command(value_of(parse_command(text))) == text);
        CHECK(value_of(parse_command(text)).index() == command.index());
    }
    const auto move = std::get<MoveBlade>(value_of(parse_command(format_command(commands().front()))));
    CHECK(move.to.heel == std::get<MoveBlade>(commands().front()).to.heel);
    CHECK(move.to.tip == std::get<MoveBlade>(commands().front()).to.tip);
    CHECK(format_command(Release{4}) == R"({"release":{"grasp":4}})");
}

TEST_CASE("what may be left out of a command has its default") {
    const auto move = std::get<MoveBlade>(
        value_of(parse_command(R"({"move_blade": {"heel": [0, 0, 1], "tip": [0, 0, 0]}})")));
    CHECK(move.blade == 0);
    CHECK(std::get<LiftBlade>(value_of(parse_command(R"({"lift_blade": {}})"))).complete == false);
}

TEST_CASE("a text that is no command is refused in one line") {
    CHECK(refusal("{") == "a command is one JSON object; this is no JSON");
    CHECK(refusal("[]") == R"(a command is an object with one name, as in {"undo": {}})");
    CHECK(refusal(R"({"undo": {}, "release": {}})") ==
          R"(a command is an object with one name, as in {"undo": {}})");
    CHECK(refusal(R"({"move_blad": {}})") == "command 'move_blad' is unknown; did you mean move_blade?");
    CHECK(refusal(R"({"undo": 1})") == "undo: give an object of its fields");
    CHECK(refusal(R"({"move_blade": {"heel": [0, 0, 1]}})") ==
          "move_blade: tip is missing; give three numbers");
    CHECK(refusal(R"({"move_blade": {"heel": [0, 0], "tip": [0, 0, 0]}})") ==
          "move_blade: heel must be three numbers");
    CHECK(refusal(R"({"release": {"grasp": 1e10}})") == "release: grasp must be a whole number");
    CHECK(refusal(R"({"release": {"grasp": 99999999999}})") == "release: grasp must be a whole number");
    CHECK(refusal(R"({"release": {"grap": 1}})") == "release: 'grap' is unknown; did you mean grasp?");
    CHECK(refusal(R"({"grasp": {"at": [0, 0, "x"], "radius": 1}})") == "grasp: at must be three numbers");
    CHECK(refusal(R"({"prescribe": {"nodes": [1, 2.5]}})") == "prescribe: nodes must be whole numbers");
}

TEST_CASE("a record comes back from its file, its scene beside it") {
    const TemporaryFolder folder;
    Record record{
        .scene = "liver.json", .overrides = {"tissue.damping=1"}, .steps = 70, .hash = 0xfedcba9876543210};
    for (const Command& command : commands()) {
        record.commands.push_back({.step = 10, .command = command, .until = 20});
    }
    must(write_record(folder.file("r.json"), record));
    const Record read = value_of(load_record(folder.file("r.json")));
    CHECK(read.scene == folder.file("liver.json"));
    CHECK(read.overrides == record.overrides);
    CHECK(read.steps == 70);
    CHECK(read.hash == record.hash);
    REQUIRE(read.commands.size() == record.commands.size());
    for (std::size_t i = 0; i < read.commands.size(); ++i) {
        CHECK(read.commands[i].step == 10);
        CHECK(read.commands[i].until == 20);
        CHECK(format_command(read.commands[i].command) == format_command(record.commands[i].command));
    }
}

TEST_CASE("a file that is no record is refused in one line") {
    const TemporaryFolder folder;
    CHECK(refused_file(folder, "") == "not JSON; give a record that resect has written");
    CHECK(refused_file(folder, "[]") == "a record is one JSON object");
    CHECK(refused_file(folder, "{}") == "scene is missing or no path");
    CHECK(refused_file(folder, R"({"scene": "s", "overrides": [1]})") ==
          "overrides: give texts, as in \"tissue.damping=1\"");
    CHECK(refused_file(folder, R"({"scene": "s", "overrides": [], "commands": [{"step": 1}]})") ==
          "commands[0]: until is missing or no whole number");
    CHECK(
        refused_file(folder, R"({"scene": "s", "overrides": [], "commands": [{"step": -1, "until": 0}]})") ==
        "commands[0]: step is -1; steps count from 0");
    CHECK(
        refused_file(
            folder, R"({"scene": "s", "overrides": [], "commands": [{"step": 1, "until": 2, "und": {}}]})") ==
        "commands[0]: command 'und' is unknown; did you mean undo?");
    CHECK(
        refused_file(folder,
                     R"({"scene": "s", "overrides": [], "commands": [], "steps": 4, "state_hash": "xyz"})") ==
        "state_hash must be 16 hexadecimal digits");
    CHECK(refusal_of(load_record(folder.file("none.json"))).find("none.json") != std::string::npos);
}

TEST_CASE("a record that is cut off or damaged anywhere is read or refused, never worse") {
    const TemporaryFolder folder;
    Record record{.scene = "s.json", .steps = 3};
    for (const Command& command : commands()) {
        record.commands.push_back({.step = 1, .command = command, .until = 2});
    }
    const std::string path = folder.file("r.json");
    must(write_record(path, record));
    std::ifstream file(path);
    const std::string whole((std::istreambuf_iterator<char>(file)), {});
    int read = 0, refused = 0;
    const auto load = [&](const std::string& text) {
        std::ofstream(path) << text;
        const Result<Record> loaded = load_record(path);
        ++(loaded ? read : refused);
        if (!loaded) { CHECK(loaded.error().message.find('\n') == std::string::npos); }
    };
    for (std::size_t at = 0; at < whole.size(); ++at) {
        load(whole.substr(0, at));
        std::string damaged = whole;
        damaged[at] = "\0\xff\"{}[]-9"[at % 9];
        load(damaged);
    }
    CHECK(refused > int(whole.size()));
    CHECK(read > 0);
    CHECK(refusal_of(parse_command(std::string(100000, '['))) ==
          "a command is one JSON object; this is no JSON");
    CHECK(refusal(R"({"set_gravity": {"gravity": [0, 0, 1e999]}})") ==
          "a command is one JSON object; this is no JSON");
    CHECK(refusal(R"({"release": {"grasp": 18446744073709551615}})") ==
          "release: grasp must be a whole number");
}
