// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <random>

#include "server/frame.hpp"
#include "server/message.hpp"

using namespace server;

namespace {

const std::vector<std::string> good = {
    R"({"id":1,"command":{"move_blade":{"blade":0,"heel":[0,0,1],"tip":[0,1,0]}}})",
    R"({"id":2,"command":{"undo":{}}})",
    R"({"id":3,"pause":true})",
    R"({"id":4,"step":1000})",
    R"({"id":5,"speed":0.25})",
    R"({"id":6,"scene":"liver"})",
    R"({"id":7,"reset":true})",
    R"({"id":8,"show":{"stress":true,"elements":false}})",
    R"({"id":9,"save":"record"})",
    R"({"save":"cut.obj","id":10})",
    R"({"id":11,"hash":true})",
    R"({"id":2147483647,"drive":true})",
    R"({"seen":4294967295})",
};

const std::vector<std::string> bad = {
    "",
    "null",
    "[]",
    "{}",
    "{\"id\":1}",
    R"({"id":1,"pause":true,"step":1})",
    R"({"pause":true})",
    R"({"id":0,"pause":true})",
    R"({"id":1.5,"pause":true})",
    R"({"id":4294967296,"pause":true})",
    R"({"id":18446744073709551615,"pause":true})",
    R"({"id":"1","pause":true})",
    R"({"id":1,"pause":1})",
    R"({"id":1,"step":0})",
    R"({"id":1,"step":1001})",
    R"({"id":1,"step":1e300})",
    R"({"id":1,"speed":-1})",
    R"({"id":1,"speed":"fast"})",
    R"({"id":1,"speed":1e999})",
    R"({"id":1,"scene":3})",
    R"({"id":1,"reset":false})",
    R"({"id":1,"show":{"stres":true}})",
    R"({"id":1,"show":true})",
    R"({"id":1,"save":"../../etc/passwd.obj"})",
    R"({"id":1,"save":"a.exe"})",
    R"({"id":1,"save":".obj"})",
    R"({"id":1,"command":{"move_blade":{}}})",
    R"({"id":1,"command":{"sudo":{}}})",
    R"({"id":1,"command":7})",
    R"({"id":1,"frobnicate":true})",
    R"({"seen":-1})",
    R"({"seen":4294967296})",
    "\xff\xfe",
    "{\"id\":1,\"scene\":\"\xff\"}",
};

bool is_refusal(const Parsed& parsed) {
    const auto* refusal = std::get_if<Refusal>(&parsed);
    return refusal != nullptr && !refusal->message.empty() &&
           refusal->message.find('\n') == std::string::npos;
}

} // namespace

TEST_CASE("what a page may ask is understood") {
    for (const std::string& text : good) {
        CAPTURE(text);
        CHECK(std::holds_alternative<Message>(parse_text(text)));
    }
    const Message message = std::get<Message>(parse_text(good[9]));
    CHECK(message.id == 10);
    CHECK(std::get<Save>(message.request).what == "cut.obj");
    const Message told = std::get<Message>(parse_text(good[0]));
    CHECK(std::holds_alternative<resect::MoveBlade>(std::get<Tell>(told.request).command));
}

TEST_CASE("what a page may not ask is refused in a line") {
    for (const std::string& text : bad) {
        CAPTURE(text);
        CHECK(is_refusal(parse_text(text)));
    }
    const Refusal refusal = std::get<Refusal>(parse_text(R"({"id":7,"paus":true})"));
    CHECK(refusal.id == 7);
    CHECK(refusal.message.find("'paus' is unknown; give one of command, pause") != std::string::npos);
}

TEST_CASE("brackets within brackets do not reach what would call itself for each") {
    const std::string deep(60000, '[');
    CHECK(is_refusal(parse_text(R"({"id":1,"command":)" + deep + std::string(60000, ']') + "}")));
    CHECK(is_refusal(parse_text(deep)));
}

TEST_CASE("damaged and random bytes are messages or refusals, and nothing worse") {
    std::mt19937 random(20051);
    const auto any = [&](std::size_t below) { return random() % below; };
    const std::string upload = build_file("a.msh", std::string(50, 'x'));
    for (int i = 0; i < 30000; ++i) {
        std::string text = good[any(good.size())];
        std::string bytes = upload;
        for (std::size_t k = 1 + any(4); k > 0; --k) {
            text[any(text.size())] = static_cast<char>(random());
            bytes[any(bytes.size())] = static_cast<char>(random());
        }
        if (any(3) == 0) { text.resize(any(text.size())); }
        if (any(3) == 0) { bytes.resize(any(bytes.size())); }
        for (const Parsed& parsed :
             {parse_text(text), parse_binary(bytes), parse_text(bytes), parse_binary(text)}) {
            if (!std::holds_alternative<Message>(parsed)) { REQUIRE(is_refusal(parsed)); }
        }
    }
}

TEST_CASE("names of uploads stay in their folder") {
    CHECK(safe_name("liver.msh") == "liver.msh");
    CHECK(safe_name("/home/me/my liver (2).msh") == "my_liver__2_.msh");
    CHECK(safe_name("C:\\organs\\liver.vtu") == "liver.vtu");
    CHECK(safe_name("../../.ssh/authorized_keys") == "authorized_keys");
    CHECK(safe_name("..") == std::nullopt);
    CHECK(safe_name("/") == std::nullopt);
    CHECK(safe_name(std::string(5000, 'a') + ".msh")->size() == 100);
}
