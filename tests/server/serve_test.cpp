// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bench/client.hpp"
#include "bench/rubbish.hpp"
#include "server/live_server.hpp"

using namespace resect;
using bench::Client;
using Json = nlohmann::json;

namespace {

std::string move_blade(int id, double z) {
    return Json{
        {"id", id},
        {"command", {{"move_blade", {{"blade", 0}, {"heel", {0.03, -0.03, z}}, {"tip", {0.03, 0.09, z}}}}}}}
        .dump();
}

/// Cuts the cuboid in two, with frames in between.
void cut_through(Client& page) {
    for (int i = 0; i <= 20; ++i) {
        page.send_text(move_blade(100 + i, 0.07 - 0.005 * i));
        page.read_until("status");
    }
    page.send_text(R"({"id":200,"command":{"lift_blade":{"blade":0}}})");
}

std::string ask_hash(Client& page, int id) {
    page.send_text(Json{{"id", id}, {"hash", true}}.dump());
    return page.read_until("hash")["hash"];
}

} // namespace

TEST_CASE("only pages of ours are let in") {
    using server::is_welcome;
    CHECK(is_welcome("localhost:8080", "", {}));
    CHECK(is_welcome("localhost:8080", "http://localhost:8080", {}));
    CHECK(is_welcome("127.0.0.1:9", "http://127.0.0.1:9", {}));
    CHECK(is_welcome("[::1]:8080", "http://[::1]:8080", {}));
    CHECK(is_welcome("theatre.lan", "https://theatre.lan", {"theatre.lan"}));
    CHECK_FALSE(is_welcome("", "", {}));
    CHECK_FALSE(is_welcome("evil.example:8080", "", {}));
    CHECK_FALSE(is_welcome("localhost.evil.example", "", {}));
    CHECK_FALSE(is_welcome("localhost:8080", "http://evil.example", {}));
    CHECK_FALSE(is_welcome("localhost:8080", "http://localhost:8081", {}));
    CHECK_FALSE(is_welcome("localhost:8080", "null", {}));
    LiveServer live;
    CHECK(Client(live.port()).upgrade("localhost", "Origin: http://evil.example\r\n").find(" 403 ") !=
          std::string::npos);
    CHECK(Client(live.port()).upgrade("evil.example").find(" 403 ") != std::string::npos);
    CHECK(Client(live.port()).upgrade("localhost", "Origin: http://localhost\r\n").find(" 101 ") !=
          std::string::npos);
}

TEST_CASE("files of the page are served, and nothing beside them") {
    LiveServer live("cuboid", {{"/", {"<html>", "text/html"}}, {"/a.js", {"run()", "text/javascript"}}});
    const auto status = [&](const std::string& path) {
        return Client(live.port()).ask(path, "Host: localhost\r\n").substr(9, 3);
    };
    CHECK(status("/") == "200");
    CHECK(status("/a.js?v=1") == "200");
    CHECK(status("/../../../etc/passwd") == "404");
    CHECK(status("/%2e%2e/etc/passwd") == "404");
    CHECK(status("/ws") == "404"); // no handshake
    Client post(live.port());
    post.send_raw("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\n\r\nx");
    CHECK(post.ask("/", "Host: localhost\r\n").substr(9, 3) == "405");
}

TEST_CASE("what a page did is saved, and replays to the same hash") {
    LiveServer live;
    Client page(live.port());
    REQUIRE(page.upgrade().find(" 101 ") != std::string::npos);
    const Json hello = page.read_until("hello");
    CHECK(hello["driving"] == true);
    CHECK(hello["scenes"].size() >= 5);
    CHECK(page.read_until("scene")["elements"] == 5832);
    const std::string before = ask_hash(page, 1);
    page.send_text(R"({"id":2,"pause":true})");
    const std::int64_t paused_at = page.read_until("status")["step"];
    for (int i = 1; i <= 5; ++i) {
        page.send_text(Json{{"id", 2 + i}, {"step", i}}.dump());
    }
    std::int64_t step = paused_at;
    while (step < paused_at + 15 && page.is_open()) {
        step = page.read_until("status")["step"];
    }
    CHECK(step == paused_at + 15);
    cut_through(page);
    const Json parted = page.wait_for_pieces(2); // while paused, too
    REQUIRE(parted.is_object());
    CHECK(parted["cut_elements"] > 20);
    page.send_text(R"({"id":3,"pause":false})");
    page.send_text(R"({"id":4,"command":{"set_gravity":{"gravity":[0,0,-1]}}})");
    page.send_text(R"({"id":5,"save":"record"})");
    const Json saved = page.read_until("saved");
    const Record record = must(load_record(saved["path"]));
    CHECK(record.commands.size() == 23);
    Scene scene = must(load_scene(record.scene, record.overrides));
    scene.setup.threads = 2;
    Simulation again = must(Simulation::create(std::move(scene.setup)));
    must(again.replay(record.commands, record.steps));
    CHECK(again.hash() == record.hash);
    CHECK(again.pieces().size() == 2);
    page.send_text(R"({"id":6,"command":{"undo":{}}})");
    page.send_text(R"({"id":7,"pause":true})");
    const Json whole = page.wait_for_pieces(1);
    REQUIRE(whole.is_object());
    CHECK(whole["cut_elements"] == 0);
    CHECK(ask_hash(page, 8) != before); // time has gone on since
}

TEST_CASE("one drives, the others watch, and may take over when it has left") {
    LiveServer live;
    auto driver = std::make_unique<Client>(live.port());
    driver->upgrade();
    CHECK(driver->read_until("hello")["driving"] == true);
    driver->send_text(move_blade(1, 0.08));
    Client watcher(live.port());
    watcher.upgrade();
    CHECK(watcher.read_until("hello")["driving"] == false);
    watcher.send_text(R"({"id":1,"pause":true})");
    const Json refused = watcher.read_until("refused");
    CHECK(refused["id"] == 1);
    CHECK(refused["message"].get<std::string>().find("another page drives") != std::string::npos);
    watcher.send_text(R"({"id":2,"drive":true})");
    CHECK(watcher.read_until("refused")["id"] == 2);
    CHECK(ask_hash(watcher, 3).size() == 16);
    driver.reset();
    CHECK(watcher.read_until("driving")["driving"] == true); // the driver left
    watcher.send_text(move_blade(4, 0.08));                  // the blade that was left has been lifted
    watcher.send_text(R"({"id":5,"command":{"lift_blade":{"blade":0}}})");
    watcher.send_text(R"({"id":6,"command":{"lift_blade":{"blade":0}}})");
    CHECK(watcher.read_until("refused")["id"] == 6);
}

TEST_CASE("scenes change, bodies are dropped in, and broken ones explain themselves") {
    LiveServer live;
    Client page(live.port());
    page.upgrade();
    page.read_until("scene");
    page.send_text(R"({"id":1,"scene":"strip"})");
    CHECK(page.read_until("scene")["name"] == "strip");
    page.send_text(R"({"id":2,"scene":"none"})");
    CHECK(page.read_until("refused")["id"] == 2);
    page.send_binary(server::build_file("broken.msh", "$MeshFormat\nrubbish\n"));
    CHECK(page.read_until("refused")["message"].get<std::string>().find("broken.msh") != std::string::npos);
    CHECK(std::filesystem::is_empty(live.folder.file("out"))); // and leave nothing
    page.send_binary("RSCTnonsense");
    CHECK(page.read_until("refused")["message"].get<std::string>().find("docs/protocol.md") !=
          std::string::npos);
    const std::string path = live.folder.file("bar.msh");
    must(write_body(path, must(make_block({0.1, 0.02, 0.02}, {8, 2, 2}))));
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    page.send_binary(server::build_file("my bar.msh", bytes));
    const Json scene = page.read_until("scene");
    CHECK(scene["title"] == "my_bar.msh");
    CHECK(scene["elements"] == 192);
    page.send_text(R"({"id":3,"save":"record"})");
    const Record record = must(load_record(page.read_until("saved")["path"]));
    CHECK(must(load_scene(record.scene)).setup.body.elements.tets.size() == 192);
    page.send_binary(server::build_file("my bar.msh", bytes.substr(0, bytes.size() / 2)));
    CHECK(page.read_until("refused")["message"].get<std::string>().find("my_bar.msh") != std::string::npos);
    CHECK(must(load_scene(record.scene)).setup.body.elements.tets.size() == 192); // as it was
    page.send_text(R"({"id":4,"save":"bar.vtu"})");
    CHECK(must(load_body(page.read_until("saved")["path"])).elements.tets.size() == 192);
}

TEST_CASE("connections that are hostile, half closed or stalled hurt nobody") {
    LiveServer live;
    Client page(live.port());
    page.upgrade();
    page.read_until("scene");
    Client stalled(live.port()); // never reads a frame
    stalled.upgrade();
    Client half(live.port());
    half.send_raw("GET /ws HTTP/1.1\r\nHost: local");
    for (int i = 0; i < 50; ++i) {
        bench::send_rubbish(live.port(), i);
    }
    Client loud(live.port());
    loud.upgrade();
    loud.send_text(std::string(70000, 'x'));
    while (const auto received = loud.read()) {
        if (received->kind == 8) { CHECK(received->payload.find("64 KiB") != std::string::npos); }
    }
    Client fast(live.port());
    fast.upgrade();
    for (int i = 0; i < 6000; ++i) {
        fast.send_text("{\"seen\":1}");
    }
    while (const auto received = fast.read()) {
        if (received->kind == 8) { CHECK(received->payload.find("too many messages") != std::string::npos); }
    }
    cut_through(page);
    page.send_text(R"({"id":5,"save":"record"})");
    const Record record = must(load_record(page.read_until("saved")["path"]));
    Simulation again = must(Simulation::create(must(load_scene(record.scene)).setup));
    must(again.replay(record.commands, record.steps));
    CHECK(again.hash() == record.hash);
}
