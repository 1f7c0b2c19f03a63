// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "program.hpp"

using namespace resect;

TEST_CASE("what a run did is replayed to the same hash, by another number of threads") {
    const TemporaryFolder folder;
    const std::string record = folder.file("record.json");
    const Outcome ran =
        run_resect("run " + scene("cuboid.json") + " --seconds 0.3 --threads 1 --record " + record);
    REQUIRE(ran.status == 0);
    const Outcome again =
        run_resect("replay " + record + " --check-hash --threads 2 --surface " + folder.file("s.obj"));
    CHECK(again.err == "");
    CHECK(again.status == 0);
    CHECK(again.out.find(", as recorded") != std::string::npos);
    CHECK(read_text(folder.file("s.obj")).size() > 10000);

    std::string other = read_text(record);
    const std::size_t at = other.find("\"state_hash\": \"") + 15;
    other[at] = other[at] == '0' ? '1' : '0';
    write_text(record, other);
    CHECK(run_resect("replay " + record).status == 0);
    const Outcome checked = run_resect("replay " + record + " --check-hash");
    CHECK(checked.status == 1);
    CHECK(checked.err.find("ended in another state than was recorded") != std::string::npos);
}

TEST_CASE("a record that cannot be replayed is refused in one line") {
    const TemporaryFolder folder;
    CHECK(is_refusal(run_resect("replay")));
    CHECK(is_refusal(run_resect("replay " + folder.file("none.json"))));
    write_text(folder.file("r.json"), R"({"scene": "none.json", "overrides": [], "commands": [], "steps": 0,
                                          "state_hash": "0"})");
    const Outcome lost = run_resect("replay " + folder.file("r.json"));
    CHECK(is_refusal(lost));
    CHECK(lost.err.find("none.json") != std::string::npos);
}
